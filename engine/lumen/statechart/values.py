"""What a step takes and gives: the whole state of a running behaviour as an immutable value."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple, TypeAlias

from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.machines import Transition
from lumen.language.nanoseconds import in_seconds

MAX_TIMERS = 10_000
"""How many timers may wait before a `send` is refused: events that send two each would fill the memory."""


class Timer(NamedTuple):
    """Something that happens at `due_ns` [ns], `delay_ns` [ns] after it was set: whole numbers, which add up exactly.

    An `after`, an `at` and a `wait` (of a `do`) end with their state, whose path they hold; a `send` ends with
    `cancel`, and may go `to` another behaviour.
    """

    id: str
    due_ns: int
    delay_ns: int
    event: str
    data: Any = None
    state: str = ""
    kind: Literal["after", "at", "send", "wait"] = "send"
    to: str = ""

    @property
    def due(self) -> float:
        """When it happens [s]."""
        return in_seconds(self.due_ns)

    @property
    def delay(self) -> float:
        """How long after it was set that is [s]."""
        return in_seconds(self.delay_ns)


class Awaiting(NamedTuple):
    """A `do` stands before a command or a `wait` of that id, since `at` [s]."""

    id: str
    at: float = 0.0


class Within(NamedTuple):
    """A `do` stands in the action number `place` of one of its blocks: the list itself, or the branch of an `if`."""

    block: Literal["do", "then", "else"]
    place: int
    inner: "Position"


class Fork(NamedTuple):
    """A `do` stands in a `parallel`: where in each branch, None in those that have ended."""

    branches: "tuple[Position | None, ...]"


Position: TypeAlias = Awaiting | Within | Fork


def awaited(position: Position | None) -> Iterator[str]:
    """The ids that a position awaits."""
    match position:
        case Awaiting(id):
            yield id
        case Within(_, _, inner):
            yield from awaited(inner)
        case Fork(branches):
            for branch in branches:
                yield from awaited(branch)


class Halted(NamedTuple):
    """Where a `do` stood when its state was left at `at` [s], for a history state that leads back into it."""

    position: Within
    at: float


class Counters(NamedTuple):
    """How many ids were given out: `c1, c2, …` to commands, `d1, d2, …` to awaited ones, `s1, s2, …` to timers."""

    commands: int = 0
    awaited: int = 0
    timers: int = 0


class Invoked(NamedTuple):
    """A behaviour that the state at path `state` has invoked, where it stands, and what had been started before it."""

    state: str
    snapshot: "Snapshot"
    commands: int = 0


class Snapshot(NamedTuple):
    """Where a behaviour stands between two macrosteps.

    `configuration` holds the names of the active states but the root (the alias where there is one, else the path);
    `doing` the position of each active `do` and `history` the paths remembered by each history state, both by path.
    `at` [s] is the time of the last event, or a later one at which it was taken off a clock; `epoch` when time 0 was
    [s since 1970, in UTC], and `timezone` where the clock on the wall hangs; `generator` the state from which
    alternatives of `say` are drawn. `invoked` are the behaviours that run within it, by their ids; its time, language,
    counters and generator are theirs too. `halted` is where a `do` stood that says how it is resumed, when its state
    was last left, by path. `place` is where the robot is, by the last `arrived` and `left`, empty where it is at none.
    `output` is that of the final state in which the machine has come to its end.
    Mappings in it are never changed, only replaced.
    """

    configuration: frozenset[str]
    context: Mapping[str, Any]
    at: float = 0.0
    language: str = ""
    timers: tuple[Timer, ...] = ()
    doing: Mapping[str, Within] = {}
    history: Mapping[str, tuple[str, ...]] = {}
    counters: Counters = Counters()
    generator: int = 0
    epoch: float = 0.0
    invoked: Mapping[str, Invoked] = {}
    halted: Mapping[str, Halted] = {}
    place: str = ""
    timezone: str = ""
    output: Any = None


class Step(NamedTuple):
    """One macrostep: what happened, which states were left and entered, what has to be done, and where it ends.

    `event` is None for the first step. `transitions` are those taken and `raised` the internal events, in order; an
    `error.*` among them says its `reason`, and where the fault stands, in its data. The root is not listed. `invoked`
    are the steps of invoked behaviours, each with its id, in order; what they ask for is among `commands`, where the
    ids of their commands end in `@` and the id of the invoke.
    """

    event: Event | None
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    commands: tuple[Command, ...]
    snapshot: Snapshot
    transitions: tuple[Transition, ...] = ()
    raised: tuple[Event, ...] = ()
    invoked: "tuple[tuple[str, Step], ...]" = ()
