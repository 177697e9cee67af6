"""The values that a step consumes and produces: the whole state of a running behaviour is immutable."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple, TypeAlias

from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.machines import Transition
from lumen.language.nanoseconds import in_seconds

MAX_TIMERS = 10_000
"""The number of waiting timers from which a `send` is refused, because sends that double could exhaust the memory."""


class Timer(NamedTuple):
    """An event that will happen; times are integers [ns] on the clock of the snapshot, so that sums are exact."""

    id: str
    """The id of the `send` or `wait`; for `after` and `at` the name of the event."""
    due_ns: int
    """When the event happens [ns]."""
    delay_ns: int
    """The time between the timer's start and `due_ns` [ns]."""
    event: str
    data: Any = None
    state: str = ""
    """The path of the state whose exit cancels the timer of an `after`, `at` or `wait`; empty for a `send`."""
    kind: Literal["after", "at", "send", "wait"] = "send"
    to: str = ""
    """The other behaviour that receives a `send`; empty for the machine itself."""

    @property
    def due(self) -> float:
        """Return when the event happens [s]."""
        return in_seconds(self.due_ns)

    @property
    def delay(self) -> float:
        """Return the delay [s]."""
        return in_seconds(self.delay_ns)


class Awaiting(NamedTuple):
    """The position of a `do` that awaits a command or `wait`."""

    id: str
    """The id of the command or timer."""
    at: float = 0.0
    """When the wait began [s]."""


class Within(NamedTuple):
    """The position of a `do` in one of its blocks: the list itself, or a branch of an `if`."""

    block: Literal["do", "then", "else"]
    place: int
    """The index of the action in the block."""
    inner: "Position"
    """The position in that action."""


class Fork(NamedTuple):
    """The position of a `do` inside a `parallel` or `ask`: that of each branch, None for branches that have ended."""

    branches: "tuple[Position | None, ...]"


Position: TypeAlias = Awaiting | Within | Fork


def awaited(position: Position | None) -> Iterator[str]:
    """Yield the ids that a position awaits."""
    match position:
        case Awaiting(id):
            yield id
        case Within(_, _, inner):
            yield from awaited(inner)
        case Fork(branches):
            for branch in branches:
                yield from awaited(branch)


class Halted(NamedTuple):
    """The position of a `do` whose state was left at `at` [s], for a history state that restores the state."""

    position: Within
    at: float


class Counters(NamedTuple):
    """How many ids have been assigned: `c1`, `c2`, … to commands, `d1`, … to awaited ones, `s1`, `w2`, … to timers."""

    commands: int = 0
    awaited: int = 0
    timers: int = 0


class Invoked(NamedTuple):
    """A behaviour invoked by a state."""

    state: str
    """The path of the state."""
    snapshot: "Snapshot"
    commands: int = 0
    """The number of commands that were started before the behaviour."""


class Snapshot(NamedTuple):
    """The state of a behaviour between two macrosteps; its mappings are replaced, never changed."""

    configuration: frozenset[str]
    """The names of the active states except the root: the alias if there is one, else the path."""
    context: Mapping[str, Any]
    at: float = 0.0
    """The time of the last event [s], or a later time at which the snapshot was taken."""
    language: str = ""
    timers: tuple[Timer, ...] = ()
    doing: Mapping[str, Within] = {}
    """The position of each active `do`, by the path of the state."""
    history: Mapping[str, tuple[str, ...]] = {}
    """The paths that each history state remembers, by its own path."""
    counters: Counters = Counters()
    generator: int = 0
    """The state of the random generator for the alternatives of `say`."""
    epoch: float = 0.0
    """The time of `at` = 0 [s since 1970, UTC]."""
    invoked: Mapping[str, Invoked] = {}
    """The behaviours that run inside this one, by id; they share its time, language, counters and generator."""
    halted: Mapping[str, Halted] = {}
    """The position of each `do` with a `resume` when its state was last left, by path."""
    place: str = ""
    """The place of the robot after the last `arrived` or `left`; empty if the robot is at no place."""
    timezone: str = ""
    """The IANA name of the time zone of the wall clock."""
    output: Any = None
    """The output of the final state in which the machine has ended; None before, or if it has no output."""


class Step(NamedTuple):
    """One macrostep: its cause, the states exited and entered (without the root), its commands and its result."""

    event: Event | None
    """The event that caused the step; None for the first step."""
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    commands: tuple[Command, ...]
    """The commands to perform; ids of those of invoked behaviours end in `@` and the id of the invoke."""
    snapshot: Snapshot
    transitions: tuple[Transition, ...] = ()
    """The transitions taken, in order."""
    raised: tuple[Event, ...] = ()
    """The internal events, in order; the data of an `error.*` has its `reason` and, if known, its place."""
    invoked: "tuple[tuple[str, Step], ...]" = ()
    """The steps of invoked behaviours, each with its id, in order."""
