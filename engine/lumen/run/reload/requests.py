"""What an operator may ask of a running exhibition: messages on `lumen.config.command`."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumen.errors import BusError, UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.routing_keys import CONFIG_COMMAND, CONFIG_STATUS, INTERNAL_ALIASES, key_of_robot
from lumen.ports import Bus, Message

COMMAND, STATUS = INTERNAL_ALIASES[CONFIG_COMMAND], INTERNAL_ALIASES[CONFIG_STATUS]
"""Where orders come, and what becomes of them is told, while one robot is on the bus."""
REQUESTS = ("reload", "apply", "try", "refuse", "rollback", "dry-run", "status", "stop")
WAITING = 100


def command_key(robot: str) -> str:
    """Where orders to that robot's exhibition come."""
    return key_of_robot(CONFIG_COMMAND, robot)


def status_key(robot: str) -> str:
    """Where that robot's exhibition tells what becomes of saved files."""
    return key_of_robot(CONFIG_STATUS, robot)


@dataclass(frozen=True)
class ReloadRequest:
    """`verb` is one of `REQUESTS`; `now` does not wait for what is under way. `answer` sends a body to who asked.

    With `between` it waits for the end of a visit, however long that is.
    """

    verb: str
    now: bool
    answer: Callable[[Any], None]
    between: bool = False


def request_from(message: Message, bus: Bus) -> ReloadRequest:
    """The order that a message is; raises UsageError that says what would be right."""
    body = message.body
    if not isinstance(body, dict) or not isinstance(verb := body.get("command"), str):
        raise UsageError(f'send a body such as {{"command": "reload"}}, with one of the commands {", ".join(REQUESTS)}')
    if verb not in REQUESTS:
        raise UsageError(f"there is no command `{verb[:40]}`: {did_you_mean(verb[:40], REQUESTS, 'there are')}")
    if not isinstance(body.get("now", False), bool):
        raise UsageError("`now` must be true or false")
    return ReloadRequest(verb, body.get("now", False), answering(message, bus))


def answering(message: Message, bus: Bus) -> Callable[[Any], None]:
    """Sends a body to who wants an answer; to nobody where the bus is gone."""

    def answer(body: Any) -> None:
        try:
            bus.reply(message, body)
        except BusError:
            return

    return answer
