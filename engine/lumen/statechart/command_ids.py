"""Ids of commands and timers as they leave a machine, and the way back to who awaits them.

What an invoked behaviour starts as `d7` is `d7@quiz` outside, where `quiz` is the id of its invoke; two levels deep it
is `d7@hint@quiz`.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.language.commands import Cancel, Command, Start
from lumen.language.events import RESULT, Event

ANSWER_KINDS = ("done", "error", "cancelled", "lost", "answer")


class CommandAnswer(NamedTuple):
    """What became of a command: `done`, or `error`, `cancelled` or `lost` (forgotten by the robot) with a reason.

    An `answer` is (part of) what is known about a question; its `data` says it.
    """

    kind: str
    id: str
    reason: str
    data: Any = None


def answer_of(event: Event) -> CommandAnswer | None:
    """The robot's answer that an event is; None where it is something else."""
    kind, _, id = event.name.partition(".command.")
    if kind not in ANSWER_KINDS or id[:1] not in ("c", "d") or not id[1:].partition("@")[0].isdecimal():
        return None
    data = event.data if isinstance(event.data, Mapping) else {}
    return CommandAnswer(kind, id, str(data.get("reason", "")) or kind, event.data)


def result_of(data: Any) -> Any:
    """Return what a verb of a feature returned, by the data of its `done.command.ID`; None for other commands."""
    return data.get(RESULT) if isinstance(data, Mapping) else None


def outer_id(id: str, owner: str) -> str:
    """What an id of the invoked behaviour `owner` is called outside of it."""
    return f"{id}@{owner}"


def inner_id(id: str) -> tuple[str, str]:
    """An id as the behaviour that was invoked knows it, and which that is; empty for one's own."""
    own, separator, owner = id.rpartition("@")
    return (own, owner) if separator else (id, "")


def outer_command(command: Command, owner: str) -> Command:
    """A command of an invoked behaviour as it is called outside."""
    match command:
        case Start(id, wanted):
            return Start(outer_id(id, owner), wanted)
        case Cancel(id):
            return Cancel(outer_id(id, owner))
    return command
