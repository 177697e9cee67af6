"""Finds states that lead back to themselves without a guard or a delay: by events, `do`, `invoke`, `after: 0s`."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from lumen.interpreters.expressions.tree import Identifier, walk
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
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.loading.transitions import ENDLESS_ALWAYS
from lumen.rules.events import hears
from lumen.rules.logic import tree
from lumen.rules.statecharts import ALWAYS_LOOP, within

ENDLESS_CHAIN = Code(
    "endless-chain", "statecharts", WARNING, "states lead back to themselves for ever, without a guard and without time"
)

MAX_STEPS = 1000
"""The most events and transitions of a chain that are followed: as many as the engine processes without a rest."""

MAX_STEPS_TO_REST = 20
"""The number of events and transitions after which an entered state should rest."""

MAX_WORK = 30_000
"""The most states that are visited for the chains of one behaviour; further chains are not followed."""

MAX_SHOWN_TRANSITIONS = 6
"""The number of transitions of a chain that its message names."""

MAX_INVOKED = 4
"""The depth of invoked behaviours that are followed."""

_INSTANT = (Assign, CancelSend, If, LogText, Parallel, PublishBody, Raise, Send, Wait)

_Taken = tuple[Transition, str]
"""A transition and the event that selected it; empty for `always`."""


class _UncertainError(Exception):
    """The next transition can't be predicted: it depends on a guard, a list, or unknown states."""


@dataclass
class _Survey:
    """Shared data of all chains of a machine: the order of its states, the situations seen, and the work done."""

    machine: MachineDefinition
    order: Mapping[str, int]
    """The place of each path in the document."""
    seen: set[tuple[object, ...]] = field(default_factory=set)
    work: int = 0
    _selecting: dict[str, list[Transition]] = field(default_factory=dict)

    def selecting(self, region: str) -> list[Transition]:
        """The transitions of all states in a region that an event selects."""
        if region not in self._selecting:
            states = (state for path, state in self.machine.states.items() if within(path, region))
            self._selecting[region] = [t for state in states for t in state.transitions if t.event and not t.timed]
        return self._selecting[region]


@dataclass
class _Chain:
    """A machine that is followed while no time passes and each next transition is certain.

    `active` are the paths of the active states, `begun` those whose `do` and `invoke` have begun; `unknown` are regions
    parallel to the active states in which any state may be active.
    """

    survey: _Survey
    depth: int = MAX_INVOKED
    active: set[str] = field(default_factory=set)
    begun: set[str] = field(default_factory=set)
    unknown: set[str] = field(default_factory=set)
    internal: tuple[str, ...] = ()
    timers: list[Transition | str] = field(default_factory=list)
    """Each `after: 0s` and each sent event, in their order: they come after the internal events, in the same moment."""
    taken: list[_Taken] = field(default_factory=list)
    asked: list[tuple[int, str]] = field(default_factory=list)
    """Guards of `always` that are assumed false, each with the number of transitions taken before it, and as shown."""
    assigned: int = -1
    """The number of transitions taken before the last change of the context."""
    over: bool = False

    @property
    def machine(self) -> MachineDefinition:
        return self.survey.machine

    def situation(self) -> tuple[object, ...]:
        """Everything that decides the next transition."""
        timers = tuple(timer if isinstance(timer, str) else id(timer) for timer in self.timers)
        return frozenset(self.active), frozenset(self.begun), self.internal, timers

    def stand_around(self, path: str) -> None:
        """Mark the states around that one as active, as if they had been active for a while."""
        while (outer := self.machine.states[path].parent) is not None:
            if self.machine.states[outer].kind is StateKind.PARALLEL:
                self.unknown.update(region for region in _regions(self.machine, outer) if region != path)
            self.active.add(outer)
            path = outer
        self.begun |= self.active

    def enter(self, targets: Iterable[str], domain: str | None) -> None:
        """Enter these states, those around them up to the domain, and what begins with them."""
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
            for path in tuple(found):
                state = states[path]
                if state.kind is StateKind.PARALLEL:
                    found.update(_regions(self.machine, path))
                elif state.kind is StateKind.COMPOUND and found.isdisjoint(state.children):
                    for first in state.initial:
                        add(first, path)
        for state in self._in_order(found):
            if state.kind is StateKind.HISTORY or state.for_each:
                raise _UncertainError
            self.active.add(state.path)
            names = {t.event: t for t in reversed(state.transitions) if t.timed and t.delay == 0}
            self.timers += reversed(names.values())
            self._note(state.entry)
            if state.kind is StateKind.FINAL:
                self._end(state)

    def step(self) -> bool:
        """Take the enabled transitions, or those of the next event; return False if the machine rests, or is over."""
        if self.over:
            return False
        self.survey.work += len(self.active)
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
                    raise _UncertainError  # they receive it, too
                event = timer
            else:
                return False
            found = self.selected(event)
        self.take(found, event)
        return True

    def take(self, transitions: Sequence[Transition], event: str) -> None:
        """Take these in one step; of two that leave the same states only the inner or the earlier one."""
        kept: list[Transition] = []
        for transition in transitions:
            rivals = [other for other in kept if self._conflict(transition, other)]
            if all(transition.source != o.source and within(transition.source, o.source) for o in rivals):
                kept = [*(other for other in kept if other not in rivals), transition]
        transitions = kept
        self.taken += [(transition, event) for transition in transitions]
        moves = [(t, _domain(self.machine, t)) for t in transitions if t.targets]
        for _, domain in moves:
            self._leave(domain)
        for transition in transitions:
            self._note(transition.actions)
        for transition, domain in moves:
            self.enter(transition.targets, domain)

    def _conflict(self, one: Transition, other: Transition) -> bool:
        inner, outer = _domain(self.machine, one), _domain(self.machine, other)
        return bool(one.targets and other.targets) and (within(inner, outer) or within(outer, inner))

    def _leave(self, domain: str) -> None:
        leaving = [s for s in self._in_order(self.active) if s.path != domain and within(s.path, domain)]
        for state in reversed(leaving):
            self._note(state.exit)
            self.active.discard(state.path)
            self.begun.discard(state.path)
            self.timers = [timer for timer in self.timers if isinstance(timer, str) or timer.source != state.path]
        for region in [region for region in self.unknown if within(region, domain)]:
            if any(within(path, region) and _speaks(state.exit) for path, state in self.machine.states.items()):
                raise _UncertainError
            self.unknown.discard(region)

    def _begin(self) -> None:
        """Begin each `do`, up to its first action that takes time, and each invoked behaviour."""
        for state in [s for s in self._in_order(self.active) if s.path not in self.begun]:
            self.begun.add(state.path)
            for invoke in state.invoke:
                other = self.machine.invoked.get(invoke.behavior)
                if other is None or any(_speaks((*s.entry, *s.do, *s.exit), PARENT) for s in other.states.values()):
                    raise _UncertainError
                if _is_over_at_once(other, self.depth - 1):
                    self.internal += (f"done.invoke.{invoke.id}",)
            instant = 0
            while instant < len(state.do) and all(_is_instant(step) for step in nested((state.do[instant],))):
                instant += 1
            self._note(state.do[:instant])
            if state.do and instant == len(state.do):
                self.internal += (f"done.do.{state.name}",)

    def _end(self, final: State) -> None:
        """Note which states end with a final one: the compound one around it, and parallel ones as a whole."""
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
        """Whether a state has ended; raises _UncertainError if a region of it is unknown."""
        state = self.machine.states[path]
        if path in self.unknown:
            raise _UncertainError
        if state.kind is StateKind.PARALLEL:
            return all(map(self._is_final, _regions(self.machine, path)))
        final = (p for p in (*state.children, path) if self.machine.states[p].kind is StateKind.FINAL)
        return any(p in self.active for p in final)

    def selected(self, event: str) -> list[Transition]:
        """The first transition of each innermost state that the event selects."""
        states, found = self.machine.states, list[Transition]()
        if event and any(_selects(t, event) for region in self.unknown for t in self.survey.selecting(region)):
            raise _UncertainError
        for leaf in self._in_order(self.active):
            if self.active.isdisjoint(leaf.children) and self.unknown.isdisjoint(leaf.children):
                path: str | None = leaf.path
                while path is not None:
                    rows = (t for t in states[path].transitions if _selects(t, event))
                    if (first := next(filter(self._holds, rows), None)) is not None:
                        found += [first] if not any(first is other for other in found) else []
                        break
                    path = states[path].parent
        return found

    def _holds(self, transition: Transition) -> bool:
        """Whether a selected transition is taken; a guard of `always` that uses only the context may be false."""
        if transition.hears or transition.approve:
            raise _UncertainError
        if transition.guard is None:
            return True
        names = {node.name for node, _ in walk(tree(transition.guard.source)) if isinstance(node, Identifier)}
        if transition.event or names != {"context"} or "In(" in transition.guard.source:
            raise _UncertainError
        self.asked.append((len(self.taken), transition.guard.shown))
        return False

    def _note(self, block: Sequence[PlacedAction]) -> None:
        """Note the events of a block, and whether it changes the context."""
        if any(isinstance(step.action, Assign) for step in nested(tuple(block))):
            self.assigned = len(self.taken)
        for step in block:
            match step.action:
                case Raise(event):
                    self.internal += (event,)
                case Send(event, delay=0.0, to=""):
                    self.timers.append(event)
                case Send():
                    pass
                case _ if _speaks((step,)):
                    raise _UncertainError

    def _in_order(self, paths: Iterable[str]) -> list[State]:
        return [self.machine.states[path] for path in sorted(paths, key=self.survey.order.__getitem__)]


def check(draft: ProjectDraft) -> None:
    """Report chains that never come to rest."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        told: set[int] = set()
        for chain in _beginnings(machine):
            if (around := _round(chain)) and told.isdisjoint(id(t) for t, _ in around):
                told.update(id(t) for t, _ in around)
                _report(machine, around, _asked(chain, len(around)), report)


def _beginnings(machine: MachineDefinition) -> Iterator[_Chain]:
    """Yield a chain for each transition of a state in which the machine may rest, and one for its beginning."""
    survey = _survey(machine)
    stays: dict[str | None, bool] = {None: True}
    for state in machine.states.values():  # each after the one around it
        stays[state.path] = stays[state.parent] and _stays(survey, state)
        for transition in state.transitions if stays[state.path] else ():
            if not transition.event or not (transition.targets or _speaks(transition.actions)):
                continue
            chain = _Chain(survey)
            try:
                chain.stand_around(state.path)
                chain.enter((state.path,), state.parent)
                chain.internal, chain.timers, chain.begun = (), [], set(chain.active)
                chain.take([transition], transition.event)
            except _UncertainError:
                continue
            chain.taken.clear()
            yield chain
    chain = _Chain(survey)
    try:
        chain.enter(("",), None)
    except _UncertainError:
        return
    yield chain


def _stays(survey: _Survey, state: State) -> bool:
    """Whether a state is still active at the next rest after it was entered; True if that is uncertain."""
    chain = _Chain(survey)
    try:
        chain.stand_around(state.path)
        if any(t.delay == 0 and t.targets for path in chain.active for t in survey.machine.states[path].transitions):
            return False  # a state around is left at once
        chain.enter((state.path,), state.parent)
        for _ in range(MAX_STEPS_TO_REST):
            if not chain.step():
                return state.path in chain.active
    except _UncertainError:
        return True
    return False


def _survey(machine: MachineDefinition) -> _Survey:
    return _Survey(machine, {path: number for number, path in enumerate(machine.states)})


def _round(chain: _Chain) -> list[_Taken]:
    """The transitions of a round back to a situation, or without end; empty if the chain rests or is uncertain."""
    seen: dict[tuple[object, ...], int] = {}
    try:
        for _ in range(MAX_STEPS):
            now = chain.situation()
            if now in seen:
                return _settled(chain, chain.taken[seen[now] :])
            if now in chain.survey.seen or chain.survey.work > MAX_WORK:
                return []
            chain.survey.seen.add(now)
            seen[now] = len(chain.taken)
            if not chain.step():
                return []
    except _UncertainError:
        return []
    *before, last = chain.taken  # the number of events grows without end
    back = next((i for i, (other, _) in enumerate(reversed(before)) if other is last[0]), 0)
    return _settled(chain, chain.taken[-back - 1 :])


def _settled(chain: _Chain, around: list[_Taken]) -> list[_Taken]:
    """Return a round, unless it changes the context of a guard, or has only `always` of atomic states."""
    asked = _asked(chain, len(around))
    if asked and chain.assigned > len(chain.taken) - len(around):
        return []
    states = chain.machine.states
    own = asked or any(event or states[t.source].kind is not StateKind.ATOMIC for t, event in around)
    return around if own else []


def _asked(chain: _Chain, number: int) -> list[str]:
    """The guards on which the last transitions depend."""
    return list(dict.fromkeys(shown for before, shown in chain.asked if before >= len(chain.taken) - number))


def _is_over_at_once(machine: MachineDefinition, depth: int) -> bool:
    """Whether a behaviour ends as soon as it begins; raises _UncertainError if that is not certain."""
    chain = _Chain(_survey(machine), depth)
    chain.enter(("",), None)
    for _ in range(MAX_STEPS):
        if chain.asked or chain.timers or not depth:
            break
        if not chain.step():
            return chain.over
    raise _UncertainError


def _domain(machine: MachineDefinition, transition: Transition) -> str:
    """The state that a transition does not leave: the innermost compound one around its source and its targets."""
    path = transition.source
    if transition.reenter:
        path = machine.states[path].parent or ""
    while path and not (
        machine.states[path].kind is StateKind.COMPOUND
        and all(target != path and within(target, path) for target in transition.targets)
    ):
        path = machine.states[path].parent or ""
    return path


def _regions(machine: MachineDefinition, path: str) -> list[str]:
    return [c for c in machine.states[path].children if machine.states[c].kind is not StateKind.HISTORY]


def _speaks(block: Sequence[PlacedAction], to: str = "") -> bool:
    """Whether it raises or sends an event, to that recipient if one is named."""
    actions = [step.action for step in nested(tuple(block))]
    return any(isinstance(a, Send) and a.to == to if to else isinstance(a, Raise | Send) for a in actions)


def _is_instant(step: PlacedAction) -> bool:
    """Whether an action of a `do` ends at once."""
    return isinstance(step.action, _INSTANT) and (not isinstance(step.action, Wait) or step.action.seconds == 0)


def _selects(transition: Transition, event: str) -> bool:
    if transition.timed or not event or not transition.event:
        return not event and not transition.event
    return transition.event == event if transition.exact else hears(transition.event, event)


def _report(machine: MachineDefinition, around: list[_Taken], asked: list[str], report: DocumentReport) -> None:
    first = min(range(len(around)), key=lambda i: str(around[i][0].where))
    rows = around[first:] + around[:first]
    ways = ", ".join(
        f"{_way(event)} of `{machine.states[t.source].name or machine.id}`" for t, event in rows[:MAX_SHOWN_TRANSITIONS]
    )
    message, code = "this never comes to rest", ENDLESS_CHAIN
    hint = "let something that takes time come between, such as `after: {1s: …}`, or give one of them a `guard`"
    if asked:
        message += f" while {' and '.join(f'`{shown}`' for shown in asked)} {'are' if len(asked) > 1 else 'is'} false"
        hint = "change on the way what the guard asks for, or let something that takes time come between"
    if not any(event for _, event in rows):
        code = ALWAYS_LOOP if asked else ENDLESS_ALWAYS
        if not any(t.targets for t, _ in rows):
            hint = "give it a `target`, or do them in `entry`"
    related = [(t.where, "then here") for t, _ in rows[1:]]
    report(code, rows[0][0].where, f"{message}: {ways}", hint, related=related)


def _way(event: str) -> str:
    if not event:
        return "`always`"
    return "`after: 0s`" if event.startswith("after.") else f"`{event}`"
