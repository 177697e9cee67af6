"""Ids of commands and timers outside a machine, and their conversion back to the ids inside it.

The command `d7` of an invoked behaviour is `d7@quiz` outside, if `quiz` is the id of its invoke; two levels deep it is
`d7@hint@quiz`.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.language.commands import Cancel, Command, Start
from lumen.language.events import RESULT, Event

ANSWER_KINDS = ("done", "error", "cancelled", "lost", "answer")


class CommandAnswer(NamedTuple):
    """The robot's answer to a command."""

    kind: str
    """`done`, `error`, `cancelled`, `lost` (the robot has forgotten it) or `answer` (a part of an answer, or all)."""
    id: str
    reason: str
    """The reason that the robot gives, such as for a failure; the kind if it gives none."""
    data: Any = None
    """The data of the event, such as the answer."""


def answer_of(event: Event) -> CommandAnswer | None:
    """Return the robot's answer in an event, None for any other event."""
    kind, _, id = event.name.partition(".command.")
    if kind not in ANSWER_KINDS or id[:1] not in ("c", "d") or not id[1:].partition("@")[0].isdecimal():
        return None
    data = event.data if isinstance(event.data, Mapping) else {}
    return CommandAnswer(kind, id, str(data.get("reason", "")) or kind, event.data)


def result_of(data: Any) -> Any:
    """Return the result of a feature's verb in the data of its `done.command.ID`; None for other commands."""
    return data.get(RESULT) if isinstance(data, Mapping) else None


def outer_id(id: str, owner: str) -> str:
    """Return the outside id of `id` in the invoked behaviour `owner`."""
    return f"{id}@{owner}"


def inner_id(id: str) -> tuple[str, str]:
    """Return an id without its last `@` part, and that part: the id of the invoke, empty for the machine itself."""
    own, separator, owner = id.rpartition("@")
    return (own, owner) if separator else (id, "")


def outer_command(command: Command, owner: str) -> Command:
    """Return a command of an invoked behaviour with its outside id."""
    match command:
        case Start(id, wanted):
            return Start(outer_id(id, owner), wanted)
        case Cancel(id):
            return Cancel(outer_id(id, owner))
    return command
