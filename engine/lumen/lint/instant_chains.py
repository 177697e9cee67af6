"""The course of a machine while no time passes, followed as long as each next transition is certain."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from lumen.expressions.tree import Identifier, walk
from lumen.language.actions import (
    PARENT,
    Assign,
    CancelSend,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    Send,
    Wait,
    nested,
)
from lumen.language.machines import MachineDefinition, State, StateKind, Transition, is_within
from lumen.lint.chain_survey import ChainSurvey, UncertainError, sends_event
from lumen.lint.logic import tree

MAX_STEPS = 1000
"""The maximum number of a chain's events and transitions that are followed, as in the engine."""

STATES_PER_WORK = 10
"""The number of examined states, regions or actions that count as one visit."""

EVENTS_PER_WORK = 100
"""The number of copied waiting events that count as one visit."""

MAX_INVOKED = 4
"""The maximum depth to which invoked behaviours are followed."""

_INSTANT = (Assign, CancelSend, If, LogText, Parallel, PublishBody, Raise, Send, Wait)


TakenTransition = tuple[Transition, str]
"""A transition and the event that selected it; empty for `always`."""


@dataclass
class InstantChain:
    """The course of a machine while no time passes, followed as long as each next transition is certain.

    Each method can raise UncertainError.
    """

    survey: ChainSurvey
    """The data that all chains of the machine share."""
    depth: int = MAX_INVOKED
    """The depth of invoked behaviours that can still be followed."""
    active: set[str] = field(default_factory=set)
    """The paths of the active states."""
    begun: set[str] = field(default_factory=set)
    """The paths of the states whose `do` and `invoke` have begun."""
    unknown: set[str] = field(default_factory=set)
    """Regions parallel to the active states, whose own active states are unknown."""
    internal: tuple[str, ...] = ()
    """The raised events that wait to be processed."""
    timers: list[Transition | str] = field(default_factory=list)
    """Each `after: 0s` and each sent event, in their order.

    They are processed after the internal events, at the same time.
    """
    taken: list[TakenTransition] = field(default_factory=list)
    """The transitions taken so far."""
    asked: list[tuple[int, str]] = field(default_factory=list)
    """The guards of `always` assumed to be false: the number of transitions taken before each, and its text."""
    assigned: int = -1
    """The number of transitions taken before the last change of the context; -1 without a change."""
    over: bool = False
    """Whether the machine has ended."""

    @property
    def machine(self) -> MachineDefinition:
        """The machine that is followed."""
        return self.survey.machine

    def situation(self) -> tuple[object, ...]:
        """Return everything that decides the next transition, as a hashable value."""
        timers = tuple(timer if isinstance(timer, str) else id(timer) for timer in self.timers)
        return frozenset(self.active), frozenset(self.begun), self.internal, timers

    def stand_around(self, path: str) -> None:
        """Mark the ancestors of a state as active and begun; other regions of parallel ancestors become unknown."""
        while (outer := self.machine.states[path].parent) is not None:
            if self.machine.states[outer].kind is StateKind.PARALLEL:
                regions = self.survey.regions(outer)
                self.survey.spend(len(regions) // STATES_PER_WORK)
                self.unknown.update(regions)
                self.unknown.discard(path)
            self.active.add(outer)
            path = outer
        self.begun |= self.active

    def enter(self, targets: Iterable[str], domain: str | None) -> None:
        """Enter these states and their ancestors up to the domain, and the states that are entered with them."""
        states, found = self.machine.states, set[str]()

        def add(path: str | None, top: str | None) -> None:
            while path is not None and path != top and path not in found:
                found.add(path)
                path = states[path].parent

        for target in targets:
            add(target, domain)
        before = -1
        while before < len(found):
            before = len(found)
            self.survey.spend(before // STATES_PER_WORK)
            for path in tuple(found):
                state = states[path]
                if state.kind is StateKind.PARALLEL:
                    found.update(self.survey.regions(path))
                elif state.kind is StateKind.COMPOUND and found.isdisjoint(self.survey.children[path]):
                    for first in state.initial:
                        add(first, path)
        for state in self._in_order(found):
            if state.kind is StateKind.HISTORY or state.for_each:
                raise UncertainError
            self.active.add(state.path)
            self.timers += self.survey.timers(state.path)
            self._note(state.entry)
            if state.kind is StateKind.FINAL:
                self._end(state)

    def step(self) -> bool:
        """Take the enabled transitions, or those of the next event; return False if the machine rests or has ended."""
        if self.over:
            return False
        waiting = len(self.internal) + len(self.timers)
        self.survey.spend(len(self.active) + waiting // EVENTS_PER_WORK)
        event, found = "", self.selected("")
        if not found:
            if not self.internal:
                self._begin()
            if self.internal:
                event, *rest = self.internal
                self.internal = tuple(rest)
            elif self.timers:
                timer = self.timers.pop(0)
                if not isinstance(timer, str):
                    self.take([timer] if self._holds(timer) else [], timer.event)
                    return True
                if any(self.machine.states[path].invoke for path in self.active):
                    raise UncertainError  # the invoked behaviours receive it too
                event = timer
            else:
                return False
            found = self.selected(event)
        self.take(found, event)
        return True

    def take(self, transitions: Sequence[Transition], event: str) -> None:
        """Take these transitions in one step; of two conflicting transitions, only the inner, else the earlier."""
        kept: list[Transition] = []
        for transition in transitions:
            self.survey.spend(len(kept) // STATES_PER_WORK)
            rivals = [other for other in kept if self._conflict(transition, other)]
            if all(transition.source != o.source and is_within(transition.source, o.source) for o in rivals):
                kept = [*(other for other in kept if other not in rivals), transition]
        transitions = kept
        self.taken += [(transition, event) for transition in transitions]
        moves = [(t, self.survey.domain(t)) for t in transitions if t.targets]
        for _, domain in moves:
            self._leave(domain)
        for transition in transitions:
            self._note(transition.actions)
        for transition, domain in moves:
            self.enter(transition.targets, domain)

    def _conflict(self, one: Transition, other: Transition) -> bool:
        if not (one.targets and other.targets):
            return False
        inner, outer = self.survey.domain(one), self.survey.domain(other)
        return is_within(inner, outer) or is_within(outer, inner)

    def _leave(self, domain: str) -> None:
        self.survey.spend((len(self.active) + len(self.unknown) + len(self.timers)) // STATES_PER_WORK)
        leaving = self._in_order(path for path in self.active if path != domain and is_within(path, domain))
        for state in reversed(leaving):
            self._note(state.exit)
        left = {state.path for state in leaving}
        self.active -= left
        self.begun -= left
        self.timers = [timer for timer in self.timers if isinstance(timer, str) or timer.source not in left]
        regions = {region for region in self.unknown if is_within(region, domain)}
        if any(map(self.survey.speaks_at_exit, regions)):
            raise UncertainError
        self.unknown -= regions

    def _begin(self) -> None:
        """Begin each `do`, up to its first action that takes time, and each invoked behaviour."""
        for state in [s for s in self._in_order(self.active) if s.path not in self.begun]:
            self.begun.add(state.path)
            for invoke in state.invoke:
                self.survey.spend(1)
                other = self.machine.invoked.get(invoke.behavior)
                if other is None:
                    raise UncertainError
                if _is_over_at_once(other, self.depth - 1, self.survey.ends):
                    self.internal += (f"done.invoke.{invoke.id}",)
            instant = 0
            while instant < len(state.do) and all(_is_instant(step) for step in nested((state.do[instant],))):
                self.survey.spend(1)
                instant += 1
            self._note(state.do[:instant])
            if state.do and instant == len(state.do):
                self.internal += (f"done.do.{state.name}",)

    def _end(self, final: State) -> None:
        """Raise the events of the states that end with a final state: its parent, and parallel states around it."""
        path = final.parent or ""
        while self.machine.states[path].kind is not StateKind.PARALLEL or self._is_final(path):
            state = self.machine.states[path]
            if state.kind is StateKind.COMPOUND and path != final.parent:
                return
            if not path:
                self.over = True
                return
            self.internal += (f"done.state.{state.name}",)
            path = state.parent or ""

    def _is_final(self, path: str) -> bool:
        """Return whether a state has ended. Raises UncertainError if a region of it is unknown."""
        state = self.machine.states[path]
        if path in self.unknown:
            raise UncertainError
        if state.kind is StateKind.PARALLEL:
            self.survey.spend(len(self.survey.regions(path)) // STATES_PER_WORK)
            return all(map(self._is_final, self.survey.regions(path)))
        return not self.active.isdisjoint(self.survey.final(path))

    def selected(self, event: str) -> list[Transition]:
        """Return for each innermost active state the first transition that the event selects.

        It can belong to the state or to an ancestor.
        """
        states, found, asked = self.machine.states, list[Transition](), set[str]()
        self.survey.spend(len(self.unknown) // STATES_PER_WORK)
        if event and any(self.survey.is_heard(region, event) for region in self.unknown):
            raise UncertainError
        for leaf in self._in_order(self.active):
            children = self.survey.children[leaf.path]
            path: str | None = (
                leaf.path if self.active.isdisjoint(children) and self.unknown.isdisjoint(children) else None
            )
            while path is not None and path not in asked:
                asked.add(path)
                if (first := next(filter(self._holds, self.survey.rows(path, event)), None)) is not None:
                    found.append(first)
                    break
                path = states[path].parent
        return found

    def _holds(self, transition: Transition) -> bool:
        """Return whether a selected transition is taken; False for a guard of `always` that uses only the context.

        Such a guard is assumed to be false, and added to `asked`. Raises UncertainError for any other guard, for rows
        of `hears` and for transitions that wait for approval.
        """
        if transition.hears or transition.approve:
            raise UncertainError
        if transition.guard is None:
            return True
        names = {node.name for node, _ in walk(tree(transition.guard.source)) if isinstance(node, Identifier)}
        if transition.event or names != {"context"} or "In(" in transition.guard.source:
            raise UncertainError
        self.asked.append((len(self.taken), transition.guard.shown))
        return False

    def _note(self, block: Sequence[PlacedAction]) -> None:
        """Add a block's events to the waiting events, and record whether the block changes the context."""
        steps = list(nested(tuple(block)))
        self.survey.spend(len(steps) // STATES_PER_WORK)
        if any(isinstance(step.action, Assign) for step in steps):
            self.assigned = len(self.taken)
        for step in block:
            match step.action:
                case Raise(event):
                    self.internal += (event,)
                case Send(event, delay=0.0, to=""):
                    self.timers.append(event)
                case Send():
                    pass
                case _ if sends_event((step,)):
                    raise UncertainError

    def _in_order(self, paths: Iterable[str]) -> list[State]:
        return [self.machine.states[path] for path in sorted(paths, key=self.survey.order.__getitem__)]


def round_of(chain: InstantChain) -> list[TakenTransition]:
    """Return the transitions of a loop in which a situation recurs or the queue of events grows without end.

    Empty if no loop is certain.
    """
    seen: dict[tuple[object, ...], int] = {}
    try:
        for _ in range(MAX_STEPS):
            now = chain.situation()
            if now in seen:
                return _settled(chain, chain.taken[seen[now] :])
            if now in chain.survey.seen or chain.survey.exhausted:
                return []
            chain.survey.seen.add(now)
            seen[now] = len(chain.taken)
            if not chain.step():
                return []
    except UncertainError:
        return []
    if not chain.taken:
        return []  # MAX_STEPS events were processed without selecting a transition
    *before, last = chain.taken  # the queue of events grows without end
    back = next((i for i, (other, _) in enumerate(reversed(before)) if other is last[0]), 0)
    return _settled(chain, chain.taken[-back - 1 :])


def _settled(chain: InstantChain, around: list[TakenTransition]) -> list[TakenTransition]:
    """Return the transitions of a loop; empty if the loop changes the context of a guard on which it depends.

    Also empty for a loop of only `always` of atomic states without a guard, which another rule reports.
    """
    asked = asked_guards(chain, len(around))
    if asked and chain.assigned > len(chain.taken) - len(around):
        return []
    states = chain.machine.states
    own = asked or any(event or states[t.source].kind is not StateKind.ATOMIC for t, event in around)
    return around if own else []


def asked_guards(chain: InstantChain, number: int) -> list[str]:
    """Return the guards on which the last `number` transitions depend."""
    return list(dict.fromkeys(shown for before, shown in chain.asked if before >= len(chain.taken) - number))


def _is_over_at_once(machine: MachineDefinition, depth: int, ends: dict[tuple[int, int], bool | None]) -> bool:
    """Return whether an invoked behaviour ends as soon as it begins. Raises UncertainError if that is not certain."""
    key = id(machine), depth
    if key not in ends:
        try:
            ends[key] = _ends(machine, depth, ends)
        except UncertainError:
            ends[key] = None
    if (over := ends[key]) is None:
        raise UncertainError
    return over


def _ends(machine: MachineDefinition, depth: int, ends: dict[tuple[int, int], bool | None]) -> bool:
    if any(sends_event((*s.entry, *s.do, *s.exit), PARENT) for s in machine.states.values()):
        raise UncertainError
    chain = InstantChain(ChainSurvey(machine, ends), depth)
    chain.enter(("",), None)
    for _ in range(MAX_STEPS):
        if chain.asked or chain.timers or not depth:
            break
        if not chain.step():
            return chain.over
    raise UncertainError


def _is_instant(step: PlacedAction) -> bool:
    """Return whether an action of a `do` ends immediately."""
    return isinstance(step.action, _INSTANT) and (not isinstance(step.action, Wait) or step.action.seconds == 0)
