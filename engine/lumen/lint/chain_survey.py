"""Cached answers about a machine's states and transitions, for all its chains, and a count of their work."""

from collections.abc import Sequence

from lumen.language.actions import PlacedAction, Raise, Send, nested
from lumen.language.machines import MachineDefinition, StateKind, Transition, transition_domain
from lumen.lint.events import hears

MAX_WORK = 30_000
"""The maximum number of states that are visited for a behaviour's chains; further chains are not followed."""

TRANSITIONS_PER_WORK = 10
"""The number of transitions compared with an event that count as one visit."""


class UncertainError(Exception):
    """The next transition can't be predicted: it depends on a guard, a list, or unknown states.

    It is also raised if following a chain takes more than MAX_WORK.
    """


class ChainSurvey:
    """Shared data of all chains of a machine: the order of its states, the situations seen, and the work done.

    Answers about a state or a transition are stored, because each chain needs them again. Methods that count work raise
    UncertainError if it exceeds MAX_WORK.
    """

    def __init__(self, machine: MachineDefinition, ends: dict[tuple[int, int], bool | None]) -> None:
        self.machine = machine
        self.ends = ends
        """Whether an invoked machine ends as soon as it begins, by its `id()` and the depth; None if uncertain."""
        self.order = {path: number for number, path in enumerate(machine.states)}
        """The position of each state in the document, by its path."""
        self.seen: set[tuple[object, ...]] = set()
        self.work = 0
        self.children = {path: frozenset(state.children) for path, state in machine.states.items()}
        self._regions: dict[str, list[str]] = {}
        self._inside: dict[str, tuple[list[Transition], bool]] = {}
        self._heard: dict[tuple[str, str], bool] = {}
        self._rows: dict[tuple[str, str], list[Transition]] = {}
        self._timers: dict[str, list[Transition]] = {}
        self._left: dict[str, bool] = {}
        self._domains: dict[int, str] = {}
        self._final: dict[str, list[str]] = {}

    def spend(self, work: int) -> None:
        """Count work; raise UncertainError if it is more than MAX_WORK in total."""
        self.work += work
        if self.exhausted:
            raise UncertainError

    @property
    def exhausted(self) -> bool:
        """Whether the work exceeds MAX_WORK."""
        return self.work > MAX_WORK

    def regions(self, path: str) -> list[str]:
        """Return the regions of a parallel state."""
        if path not in self._regions:
            states = self.machine.states
            self._regions[path] = [c for c in states[path].children if states[c].kind is not StateKind.HISTORY]
        return self._regions[path]

    def is_heard(self, region: str, event: str) -> bool:
        """Return whether an event selects a transition of any state in a region."""
        if (region, event) not in self._heard:
            rows, _ = self._in(region)
            self.spend(len(rows) // TRANSITIONS_PER_WORK)
            self._heard[region, event] = any(_selects(row, event) for row in rows)
        return self._heard[region, event]

    def speaks_at_exit(self, region: str) -> bool:
        """Return whether an `exit` of any state in a region raises or sends an event."""
        return self._in(region)[1]

    def _in(self, region: str) -> tuple[list[Transition], bool]:
        """Return a region's transitions with an event, and whether any `exit` there raises or sends an event."""
        if region not in self._inside:
            rows, speaks, waiting = list[Transition](), False, [region]
            while waiting:
                state = self.machine.states[waiting.pop()]
                waiting.extend(state.children)
                rows += (t for t in state.transitions if t.event and not t.timed)
                speaks = speaks or sends_event(state.exit)
            self._inside[region] = rows, speaks
        return self._inside[region]

    def rows(self, path: str, event: str) -> list[Transition]:
        """Return a state's transitions that an event selects."""
        if (path, event) not in self._rows:
            transitions = self.machine.states[path].transitions
            self.spend(len(transitions) // TRANSITIONS_PER_WORK)
            self._rows[path, event] = [row for row in transitions if _selects(row, event)]
        return self._rows[path, event]

    def timers(self, path: str) -> list[Transition]:
        """Return a state's transitions with `after: 0s`, one transition for each timer."""
        if path not in self._timers:
            rows = reversed(self.machine.states[path].transitions)
            names = {t.event: t for t in rows if t.timed and t.delay == 0}
            self._timers[path] = list(reversed(names.values()))
        return self._timers[path]

    def is_left_at_once(self, path: str) -> bool:
        """Return whether an `after: 0s` of a state has a target."""
        if path not in self._left:
            self._left[path] = any(t.delay == 0 and t.targets for t in self.machine.states[path].transitions)
        return self._left[path]

    def domain(self, transition: Transition) -> str:
        """Return the path of the state within which a transition leaves and enters states (`transition_domain`)."""
        if id(transition) not in self._domains:
            self._domains[id(transition)] = transition_domain(self.machine, transition)
        return self._domains[id(transition)]

    def final(self, path: str) -> list[str]:
        """Return the final states among a state and its children."""
        if path not in self._final:
            states = self.machine.states
            self._final[path] = [p for p in (*states[path].children, path) if states[p].kind is StateKind.FINAL]
        return self._final[path]


def sends_event(block: Sequence[PlacedAction], to: str = "") -> bool:
    """Return whether a block raises or sends an event; with `to`, only events sent to that recipient count."""
    actions = [step.action for step in nested(tuple(block))]
    return any(isinstance(a, Send) and a.to == to if to else isinstance(a, Raise | Send) for a in actions)


def _selects(transition: Transition, event: str) -> bool:
    if transition.timed or not event or not transition.event:
        return not event and not transition.event
    return transition.event == event if transition.exact else hears(transition.event, event)
