"""The entries of a journal of inputs: what happened to a behaviour, in order, and as JSON data."""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

from lumen.errors import JournalError
from lumen.language.causes import Cause, CauseKind
from lumen.language.events import Event
from lumen.language.numbers import is_number

How = Literal["heard", "timer", "goto"]
"""An event from outside, a timer that ran out, and the wish of an operator to enter a state."""

JumpKind = Literal[
    "start", "reload", "rollback", "resume", "forget", "dropped timer", "dropped event", "gap", "keyframe"
]
"""Where a behaviour went on from, by no step: begun, under other files, under those before again, after a crash,
without somebody's name, without a timer or an event that it could not bear, after entries that were lost. A `keyframe`
changes nothing; what it `said` is the `mark` of somebody, or the `note` of what they did to the robot themselves, and
`by` whom.
"""

HOWS: tuple[How, ...] = get_args(How)
JUMP_KINDS: tuple[JumpKind, ...] = get_args(JumpKind)
CAUSE_KINDS: tuple[CauseKind, ...] = get_args(CauseKind)
LATEST = 1e11
"""No time is later [s]: the year 5138."""


class JournalInput(NamedTuple):
    """An event and the step that it made, at its `position` in the journal.

    `commands` are JSON data (`command_data`), `digest` is that of the step, empty where it was `redacted`: the name of
    somebody who is forgotten was taken out.
    """

    position: int
    how: How
    event: Event
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    commands: tuple[Any, ...] = ()
    digest: str = ""
    redacted: bool = False


class JournalJump(NamedTuple):
    """The behaviour goes on from `snapshot` (frozen, None where it could not be written) at `at` [s].

    It is that of `behavior` in the bundle of that hash. `commands` are those performed for it; `said` holds what is
    known besides: the arguments of a start, who asked for it, how many entries were lost.
    """

    position: int
    kind: JumpKind
    at: float
    bundle: str
    behavior: str
    snapshot: Mapping[str, Any] | None
    commands: tuple[Any, ...] = ()
    said: Mapping[str, Any] = {}
    redacted: bool = False


RecordedEntry: TypeAlias = JournalInput | JournalJump


def entry_data(entry: RecordedEntry) -> dict[str, Any]:
    """The entry as JSON data, without its position; what is empty is left out."""
    match entry:
        case JournalInput(_, how, event, exited, entered, commands, digest, redacted):
            timer = how == "timer"  # which one it was the snapshot before says
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
    """The entry in JSON data, at that position. Raises JournalError where it is none."""
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
