"""The entries of a journal of inputs: what happened to a behaviour, in order, and as JSON data."""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

from lumen.errors import JournalError
from lumen.language.causes import Cause, CauseKind
from lumen.language.events import Event
from lumen.language.numbers import is_number

How = Literal["heard", "timer", "goto"]
"""The origin of an event: from outside, the end of a timer, or an operator's command to enter a state."""

JumpKind = Literal[
    "start", "reload", "rollback", "resume", "forget", "dropped timer", "dropped event", "gap", "keyframe"
]
"""The reason why a behaviour continued from a snapshot without a step.

It began, changed to other files (`reload`) or back to old files (`rollback`), continued after a crash (`resume`) or
without a visitor's name (`forget`), lost a timer or an event that it could not process, or entries were lost (`gap`). A
`keyframe` changes nothing: its `said` has a person's `mark`, or a `note` of an action on the robot with the person
(`by`).
"""

HOWS: tuple[How, ...] = get_args(How)
"""All values of `How`."""
JUMP_KINDS: tuple[JumpKind, ...] = get_args(JumpKind)
"""All values of `JumpKind`."""
CAUSE_KINDS: tuple[CauseKind, ...] = get_args(CauseKind)
"""All values of `CauseKind`."""
LATEST = 1e11
"""The exclusive limit of times [s]: the year 5138."""


class JournalInput(NamedTuple):
    """An event and the step that it caused."""

    position: int
    """The entry's position in the journal."""
    how: How
    """How the event reached the behaviour."""
    event: Event
    """The event that the behaviour processed."""
    exited: tuple[str, ...] = ()
    """The names of the states that the step left."""
    entered: tuple[str, ...] = ()
    """The names of the states that the step entered."""
    commands: tuple[Any, ...] = ()
    """The commands of the step as JSON data (`command_data`)."""
    digest: str = ""
    """The digest of the step; empty if the entry is redacted."""
    redacted: bool = False
    """Whether a visitor's name was removed because that visitor's data was deleted."""


class JournalJump(NamedTuple):
    """A point at which the behaviour continues from a snapshot without a step."""

    position: int
    """The entry's position in the journal."""
    kind: JumpKind
    """The reason for the jump."""
    at: float
    """The time of the jump, on the exhibition's clock [s]."""
    bundle: str
    """The hash of the bundle that runs from here on."""
    behavior: str
    """The name of the behaviour in the bundle."""
    snapshot: Mapping[str, Any] | None
    """The frozen snapshot; None if it could not be written."""
    commands: tuple[Any, ...] = ()
    """The commands that were performed at this point, as JSON data."""
    said: Mapping[str, Any] = {}
    """Details: the arguments of a start, the person who requested the jump, or the number of lost entries."""
    redacted: bool = False
    """Whether a visitor's name was removed because that visitor's data was deleted."""


RecordedEntry: TypeAlias = JournalInput | JournalJump


def entry_data(entry: RecordedEntry) -> dict[str, Any]:
    """Return an entry as JSON data, without its position.

    Empty values are left out, except an event's data other than None and a jump's snapshot. So are a timer's data and
    cause, because the snapshot before it contains the timer.
    """
    match entry:
        case JournalInput(_, how, event, exited, entered, commands, digest, redacted):
            timer = how == "timer"  # the snapshot before it contains the timer
            found: dict[str, Any] = {how: event.name, "at": event.at}
            if event.data is not None and not timer:
                found["data"] = event.data
            more: dict[str, Any] = {
                "id": event.sendid,
                "cause": list(event.cause) if event.cause and not timer else None,
                "exited": list(exited),
                "entered": list(entered),
                "commands": list(commands),
                "digest": digest,
                "redacted": redacted,
            }
            return found | {key: value for key, value in more.items() if value}
        case JournalJump(_, kind, at, bundle, behavior, snapshot, commands, said, redacted):
            besides: dict[str, Any] = {"commands": list(commands), "said": dict(said), "redacted": redacted}
            jump = {"jump": kind, "at": at, "bundle": bundle, "behavior": behavior, "snapshot": snapshot}
            return jump | {key: value for key, value in besides.items() if value}


def read_entry(data: Any, position: int) -> RecordedEntry:
    """Return the entry in JSON data, at that position. Raises JournalError if it is malformed."""
    try:
        return _jump(data, position) if "jump" in data else _input(data, position)
    except (KeyError, TypeError, ValueError, AttributeError, StopIteration, OverflowError):
        raise JournalError(f"this version of Lumen can't read entry {position} of the journal") from None


def _jump(data: Any, position: int) -> JournalJump:
    kind, snapshot, said = data["jump"], data["snapshot"], data.get("said", {})
    if kind not in JUMP_KINDS or not isinstance(snapshot, dict | None) or type(said.get("lost", 0)) is not int:
        raise TypeError
    bundle, behavior, redacted = _text(data["bundle"]), _text(data["behavior"]), data.get("redacted") is True
    commands = tuple(data.get("commands", ()))
    return JournalJump(position, kind, _time(data["at"]), bundle, behavior, snapshot, commands, said, redacted)


def _input(data: Any, position: int) -> JournalInput:
    how = next(how for how in HOWS if how in data)
    cause = _cause(data["cause"]) if "cause" in data else None
    event = Event(_text(data[how]), data.get("data"), _time(data["at"]), _text(data.get("id", "")), cause)
    states = _texts(data.get("exited", ())), _texts(data.get("entered", ()))
    commands, redacted = tuple(data.get("commands", ())), data.get("redacted") is True
    return JournalInput(position, how, event, *states, commands, _text(data.get("digest", "")), redacted)


def _cause(said: Any) -> Cause:
    *texts, time = Cause(*said)
    kind, id, key, sender = _texts(texts)
    if kind not in CAUSE_KINDS:
        raise TypeError
    return Cause(kind, id, key, sender, _time(time))


def _text(said: Any) -> str:
    if not isinstance(said, str):
        raise TypeError
    return said


def _texts(said: Any) -> tuple[str, ...]:
    return tuple(map(_text, said))


def _time(said: Any) -> float:
    if not is_number(said) or not abs(said) < LATEST:
        raise TypeError
    return float(said)
