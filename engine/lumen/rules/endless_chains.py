"""States that lead back to themselves without a guard and without time: by events, `do`, `invoke`, `after: 0s`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from lumen.language.actions import (
    Assign,
    CancelSend,
    LogText,
    PlacedAction,
    PublishBody,
    Raise,
    Send,
    nested,
)
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.rules.events import hears
from lumen.rules.statecharts import ALWAYS_LOOP

ENDLESS_CHAIN = Code(
    "endless-chain", "statecharts", WARNING, "states lead back to themselves for ever, without a guard and without time"
)

MAX_STEPS = 40
"""Transitions of a chain that are followed."""

MAX_INVOKED = 4
"""Behaviours within behaviours that are followed."""

_INSTANT = (Assign, CancelSend, LogText, PublishBody, Raise, Send)


class _UncertainError(Exception):
    """What comes next depends on a guard, on time, or on more than one state."""


@dataclass
class _Chain:
    """A machine of one active state at a time, followed for as long as nothing is left to chance."""

    machine: MachineDefinition
    state: State
    depth: int = MAX_INVOKED
    internal: tuple[str, ...] = ()
    external: tuple[str, ...] = ()
    taken: list[tuple[Transition, str]] = field(default_factory=list)
    """The transitions so far, each with the event that selected it; empty for `always`."""

    def enter(self, path: str, entered: bool = True) -> None:
        """Go to a state and what it begins in, and note the events of that."""
        state = self.machine.states[path]
        while state.kind is StateKind.COMPOUND and len(state.initial) == 1:
            self._plain(state)
            state = self.machine.states[state.initial[0]]
        if state.kind not in (StateKind.ATOMIC, StateKind.FINAL):
            raise _UncertainError
        self.state = state
        for ancestor in self._around(state):
            self._plain(ancestor)
        if entered:
            self._note(state.entry)
            self._ends()

    def step(self) -> bool:
        """Take the next transition; False if it rests."""
        state = self.state
        if (found := self._first("")) is not None:
            self._take(found, "")
            return True
        if self.internal:
            event, *rest = self.internal
            self.internal = tuple(rest)
        elif self.external:
            event, *rest = self.external
            self.external = tuple(rest)
        else:
            zero = next((t for t in state.transitions if t.delay == 0), None)
            if zero is None or zero.guard:
                return False
            self._take(zero, zero.event)
            return True
        if (found := self._first(event)) is not None:
            self._take(found, event)
        return True

    def _take(self, transition: Transition, event: str) -> None:
        self.taken.append((transition, event))
        if len(transition.targets) > 1:
            raise _UncertainError
        if transition.targets:
            self._note(self.state.exit)
        self._note(transition.actions)
        if transition.targets:
            self.enter(transition.targets[0])

    def _ends(self) -> None:
        """Note what ends as soon as the state is entered."""
        state = self.state
        if state.kind is StateKind.FINAL:
            parent = self.machine.states[state.parent or ""]
            if not parent.path:
                raise _UncertainError  # the behaviour is over
            self.internal += (f"done.state.{parent.name}",)
        if state.do and all(isinstance(step.action, _INSTANT) for step in nested(state.do)):
            self._note(state.do)
            self.internal += (f"done.do.{state.name}",)
        for invoke in state.invoke:
            other = self.machine.invoked.get(invoke.behavior)
            if other is not None and _is_over_at_once(other, self.depth - 1):
                self.internal += (f"done.invoke.{invoke.id}",)

    def _first(self, event: str) -> Transition | None:
        """The transition that is taken on an event; raises _UncertainError if a guard decides."""
        for state in (self.state, *self._around(self.state)):
            for transition in state.transitions:
                if _selects(transition, event):
                    if transition.guard or transition.hears or transition.approve:
                        raise _UncertainError
                    return transition
        return None

    def _note(self, block: Sequence[PlacedAction]) -> None:
        for step in block:
            match step.action:
                case Raise(event):
                    self.internal += (event,)
                case Send(event, delay=0.0, to=""):
                    self.external += (event,)
                case action if any(isinstance(s.action, Raise | Send) for s in nested((step,))) and not isinstance(
                    action, Send
                ):
                    raise _UncertainError

    def _around(self, state: State) -> Iterator[State]:
        while state.parent is not None:
            state = self.machine.states[state.parent]
            yield state

    def _plain(self, state: State) -> None:
        """Refuse a state around that does something when it is left or entered, or has more than one state active."""
        busy = any(isinstance(s.action, Raise | Send) for s in nested((*state.entry, *state.exit)))
        if state.kind is not StateKind.COMPOUND or state.for_each or state.invoke or (busy and state.path):
            raise _UncertainError


def check(draft: ProjectDraft) -> None:
    """Report chains that never come to rest."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for state in machine.states.values():
            _repeats(state, report)
        told: set[int] = set()
        for chain in _beginnings(machine):
            if (around := _round(chain)) and told.isdisjoint(id(t) for t, _ in around):
                told.update(id(t) for t, _ in around)
                if any(event for _, event in around):  # `always` alone is another rule's
                    _report(machine, around, report)


def _repeats(state: State, report: DocumentReport) -> None:
    """An `always` that leads nowhere and changes nothing is taken again as long as those before it are not."""
    rows = [t for t in state.transitions if not t.event]
    for i, transition in enumerate(rows):
        asked = [t.guard.shown for t in rows[:i] if t.guard]
        changes = any(isinstance(step.action, Assign) for step in nested(transition.actions))
        if asked and not transition.targets and not transition.guard and not changes:
            conditions = " and ".join(f"`{text}`" for text in asked)
            false = f"{conditions} {'are' if len(asked) > 1 else 'is'} false"
            message = (
                f"this never comes to rest while {false}: its `actions` are done again and again, before any event"
            )
            hint = "give it a `target`, or do them in `entry`"
            report(ALWAYS_LOOP, transition.where, message, hint)


def _beginnings(machine: MachineDefinition) -> Iterator[_Chain]:
    """Each state as it is entered, and each transition, as they follow an event of somebody else."""
    for state in machine.states.values():
        chain = _Chain(machine, state)
        try:
            chain.enter(state.path)
        except _UncertainError:
            continue
        yield chain
    for state in machine.states.values():
        for transition in state.transitions:
            if not any(isinstance(step.action, Raise | Send) for step in transition.actions):
                continue
            chain = _Chain(machine, state)
            try:
                chain.enter(state.path, entered=False)
                chain._take(transition, transition.event)
            except _UncertainError:
                continue
            chain.taken.clear()
            yield chain


def _round(chain: _Chain) -> list[tuple[Transition, str]]:
    """The transitions that lead from a situation back to it; empty if it rests, or if nobody can tell."""
    seen: dict[tuple[str, tuple[str, ...], tuple[str, ...]], int] = {}
    try:
        for _ in range(MAX_STEPS):
            now = (chain.state.path, chain.internal, chain.external)
            if now in seen:
                return chain.taken[seen[now] :]
            seen[now] = len(chain.taken)
            if not chain.step():
                return []
    except _UncertainError:
        return []
    return []


def _is_over_at_once(machine: MachineDefinition, depth: int) -> bool:
    """Whether a behaviour ends as soon as it begins."""
    first = machine.root
    while first.kind is StateKind.COMPOUND and len(first.initial) == 1:
        first = machine.states[first.initial[0]]
    chain = _Chain(machine, first, depth)
    try:
        if depth:
            chain.enter("")
            for _ in range(MAX_STEPS):
                if not chain.step():
                    return False
    except _UncertainError:
        return chain.state.kind is StateKind.FINAL and chain.state.parent == ""
    return False


def _selects(transition: Transition, event: str) -> bool:
    if transition.timed or not event or not transition.event:
        return not event and not transition.event
    return transition.event == event if transition.exact else hears(transition.event, event)


def _report(machine: MachineDefinition, around: list[tuple[Transition, str]], report: DocumentReport) -> None:
    first = min(range(len(around)), key=lambda i: str(around[i][0].where))
    rows = around[first:] + around[:first]
    ways = ", ".join(f"{_way(event)} of `{machine.states[t.source].name or machine.id}`" for t, event in rows)
    hint = "let something that takes time come between, such as `after: {1s: …}`, or give one of them a `guard`"
    related = [(t.where, "then here") for t, _ in rows[1:]]
    report(ENDLESS_CHAIN, rows[0][0].where, f"this never comes to rest: {ways}", hint, related=related)


def _way(event: str) -> str:
    if not event:
        return "`always`"
    return "`after: 0s`" if event.startswith("after.") else f"`{event}`"
