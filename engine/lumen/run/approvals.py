"""Events that wait for a person's GO because they would trigger a transition marked `approve: operator`.

The chart does not know about the wait: the pure step function predicts whether an event would trigger such a
transition. With GO, the event happens unchanged, and only then does the journal record it.
"""

from collections.abc import Iterator
from itertools import count
from math import inf
from typing import NamedTuple, Protocol

from lumen.errors import LumenError
from lumen.insight.explaining.names import machines_in
from lumen.language.approvals import Autonomy
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.language.machines import Approval, MachineDefinition, Transition
from lumen.language.people import PersonName
from lumen.statechart import Snapshot, Step, step
from lumen.statechart.nesting import behavior_of

MAX_WAITING = 20
"""The number of events that may wait for GO at once; one more drops the oldest."""
LEFT, REPLACED, LATE = "the behaviour left the state", "too many other approvals are waiting", "no answer came"
RELOADED, FORGOTTEN = "the files changed", "a visitor's data was deleted"


class MarkedTransition(NamedTuple):
    """A transition marked for approval, with its machine and its `approve`."""

    machine: MachineDefinition
    transition: Transition
    approval: Approval


class HeldEvent(NamedTuple):
    """An event that waits for GO."""

    id: str
    """The id of the waiting event, such as `a1`."""
    event: Event
    marked: MarkedTransition
    """The marked transition that the event would trigger."""
    since: float
    """When the event began to wait [s]."""

    @property
    def until(self) -> float:
        """The time at which the event is decided without a person [s]; infinite if it waits without limit."""
        within = self.marked.approval.within
        return inf if within is None else self.since + within


class ApprovalWatcher(Protocol):
    """An observer of events that wait for approval."""

    def approval(self, how: str, held: HeldEvent, why: str) -> None:
        """Called when an event starts to wait, is released or is dropped (`how` is `waits`, `goes` or `stays`).

        `why` is the reason, in words.
        """
        ...


class Approvals:
    """The events that are held back while autonomy is `ask`.

    If several events would trigger the same transition, only the first waits; the others are dropped.
    """

    def __init__(self) -> None:
        self.autonomy: Autonomy = "ask"
        self.waiting: tuple[HeldEvent, ...] = ()
        self.watchers: list[ApprovalWatcher] = []
        """Notified whenever an event starts to wait, is released or is dropped."""
        self.marked = False
        """Whether the machine has transitions that are marked for approval."""
        self._ids = count(1)
        self._released: list[Event] = []
        self._passing: list[Cause] = []

    @property
    def due(self) -> float:
        """The time of the next decision without a person [s]; minus infinity if an event is already released."""
        return -inf if self._released else min((held.until for held in self.waiting), default=inf)

    def use(self, machine: MachineDefinition, snapshot: Snapshot | None = None) -> None:
        """Switch to a machine; with a snapshot, drop waiting events that trigger no marked transition there."""
        self.marked = marked_transitions(machine)
        self._passing.clear()
        if snapshot:
            self.look(machine, snapshot, RELOADED)

    def holds(self, machine: MachineDefinition, snapshot: Snapshot, event: Event) -> bool:
        """Return whether an event must wait for GO, and hold it if so.

        Answers to commands, delayed events of the behaviour and events that a person has just approved never wait. If
        another event already waits for the same transition, the new event is dropped, and the result is True.
        """
        if self.autonomy == "alone" or event.sendid or ".command." in event.name:
            return False
        # compared by identity, because an equal cause may belong to another event
        if any(event.cause is cause for cause in self._passing):
            self._passing = [cause for cause in self._passing if cause is not event.cause]
            return False
        marked = _marked(machine, step(machine, snapshot, event))
        if marked is None:
            return False
        if all(held.marked.transition is not marked.transition for held in self.waiting):
            self._hold(HeldEvent(f"a{next(self._ids)}", event, marked, event.at))
        return True

    def look(self, machine: MachineDefinition, snapshot: Snapshot, why: str = LEFT) -> None:
        """Drop the waiting events that would no longer trigger a marked transition, with `why` as the reason."""
        kept = []
        for held in self.waiting:
            found = _marked_by(machine, snapshot, held.event)
            if found:
                kept.append(held._replace(marked=found))
            else:
                self._tell("stays", held, why)
        self.waiting = tuple(kept)

    def decide(self, id: str, by: str, *, go: bool) -> bool:
        """Let the event with this id happen if `go`, or else drop it; return False if there is none.

        An empty id means the oldest event.
        """
        held = next((held for held in self.waiting if id in ("", held.id)), None)
        if held is None:
            return False
        self._end(held, by, Cause("person", f"GO for {held.event.name}", sender=by) if go else None)
        return True

    def set(self, level: Autonomy, by: str) -> None:
        """Set the autonomy on behalf of the person `by`; `alone` releases all waiting events."""
        self.autonomy = level
        while level == "alone" and self.waiting:
            self.decide("", by, go=True)

    def forget(self, person: PersonName) -> None:
        """Drop every waiting event, because its data may contain the name."""
        while self.waiting:
            self._end(self.waiting[0], FORGOTTEN, None)

    def tick(self, now: float) -> list[Event]:
        """Release or drop the events whose time has passed.

        Return all events released since the last tick, dated `now` [s].
        """
        for held in [held for held in self.waiting if held.until <= now]:
            go = held.marked.approval.otherwise == "go"
            self._end(held, LATE, Cause("timer", f"approve {held.event.name}") if go else None)
        found, self._released = self._released, []
        return [event._replace(at=now) for event in found]

    def _tell(self, how: str, held: HeldEvent, why: str) -> None:
        for watcher in self.watchers:
            watcher.approval(how, held, why)

    def _hold(self, held: HeldEvent) -> None:
        if len(self.waiting) >= MAX_WAITING:
            self._end(self.waiting[0], REPLACED, None)
        self.waiting = (*self.waiting, held)
        self._tell("waits", held, "")

    def _end(self, held: HeldEvent, why: str, cause: Cause | None) -> None:
        """Stop holding an event: release it with `cause`, or drop it if `cause` is None."""
        self.waiting = tuple(other for other in self.waiting if other is not held)
        if cause:
            self._passing.append(cause)
            self._released.append(held.event._replace(cause=cause))
        self._tell("goes" if cause else "stays", held, why)


def _marked_by(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> MarkedTransition | None:
    try:
        return _marked(machine, step(machine, snapshot, event._replace(at=max(event.at, snapshot.at))))
    except LumenError:
        return None


def _marked(machine: MachineDefinition, taken: Step) -> MarkedTransition | None:
    """Return the first marked transition that a step has taken, else None."""
    return next(_all_marked(machine, taken), None)


def _all_marked(machine: MachineDefinition, taken: Step) -> Iterator[MarkedTransition]:
    for transition in taken.transitions:
        if transition.approve:
            yield MarkedTransition(machine, transition, transition.approve)
    for id, inner in taken.invoked:
        yield from _all_marked(machine.invoked[behavior_of(machine, id, inner)], inner)


def marked_transitions(machine: MachineDefinition) -> bool:
    """Return whether a behaviour, or one that it invokes, has a transition that waits for GO."""
    return any(
        transition.approve
        for _, inner in machines_in(machine)
        for state in inner.states.values()
        for transition in state.transitions
    )
