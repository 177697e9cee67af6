"""Unusual messages on the bus, at which the recording of the time before is saved."""

from lumen.language import operator_requests
from lumen.language.routing_keys import CONFIG_STATUS, INTERNAL_ALIASES, OPERATOR_REQUEST, key_of_robot
from lumen.ports import Message

FALLEN, ERROR, MARK = "fallen", "error", "mark"
MAX_TEXT = 60
NOT_TAKEN = {"refused": "reload-refused", "rolled back": "reload-rolled-back"}


def happening(message: Message, robot: str) -> str:
    """Return what a message reports about this robot, as a word or the text of a mark; empty for usual messages.

    Unusual messages report a fall, an error that reaches the behaviour, a refusal or rollback of files, or a mark.
    """
    match message.body:
        case {"ask": operator_requests.MARK.ask, **rest} if message.key in _keys(OPERATOR_REQUEST, robot):
            return f"{MARK} {str(rest.get('text') or '')[:MAX_TEXT]}".strip()
        case {"verdict": str(verdict)} if message.key in _keys(CONFIG_STATUS, robot):
            return NOT_TAKEN.get(verdict, "")
        case {"noticed": str(name), "robot": str(who)} | {"event": str(name), "robot": str(who)} if who == robot:
            return FALLEN if name == FALLEN else ERROR if name.partition(".")[0] == ERROR else ""
        case {"answer": {"kind": "error"}, "robot": str(who)} if who == robot:
            return ERROR
        case _:
            return ""


def _keys(key: str, robot: str) -> tuple[str, str]:
    """Return one of Lumen's keys with the robot's name, and its alias without a name, for a single robot."""
    return key_of_robot(key, robot), INTERNAL_ALIASES[key]
