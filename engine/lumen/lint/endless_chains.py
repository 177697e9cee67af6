"""Finds states that lead back to themselves without a guard or a delay: by events, `do`, `invoke`, `after: 0s`."""

from collections.abc import Iterable, Iterator, Sequence
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
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.lint.events import hears
from lumen.lint.logic import tree
from lumen.lint.statecharts import ALWAYS_LOOP, within
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.transitions import ENDLESS_ALWAYS

ENDLESS_CHAIN = Code("endless-chain", "statecharts", WARNING, "transitions loop for ever, without a guard or a delay")

MAX_STEPS = 1000
"""The most events and transitions of a chain that are followed: as many as the engine processes without a rest."""

MAX_STEPS_TO_REST = 20
"""The number of events and transitions after which an entered state should rest."""

MAX_WORK = 30_000
"""The most states that are visited for the chains of one behaviour; further chains are not followed."""

STATES_PER_WORK = 10
"""The number of states, regions or actions that are looked at in the time of one visit."""

TRANSITIONS_PER_WORK = 10
"""The number of transitions that are compared with an event in the time of one visit."""

EVENTS_PER_WORK = 100
"""The number of waiting events that are copied in the time of one visit."""

MAX_SHOWN_TRANSITIONS = 6
"""The number of transitions of a chain that its message names."""

MAX_INVOKED = 4
"""The depth of invoked behaviours that are followed."""

_INSTANT = (Assign, CancelSend, If, LogText, Parallel, PublishBody, Raise, Send, Wait)

_Taken = tuple[Transition, str]
"""A transition and the event that selected it; empty for `always`."""


class _UncertainError(Exception):
    """The next transition can't be predicted: it depends on a guard, a list, or unknown states.

    Also raised if following a chain further would take more than MAX_WORK.
    """


class _Survey:
    """Shared data of all chains of a machine: the order of its states, the situations seen, and the work done.

    Answers about a state or a transition are kept, since each chain asks for them again.
    """

    def __init__(self, machine: MachineDefinition, ends: dict[tuple[int, int], bool | None]) -> None:
        self.machine = machine
        self.ends = ends
        """Whether an invoked machine ends as soon as it begins, by its `id()` and the depth; None if uncertain."""
        self.order = {path: number for number, path in enumerate(machine.states)}
        """The place of each path in the document."""
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
        """Count work; raise _UncertainError if it is more than MAX_WORK in total."""
        self.work += work
        if self.exhausted:
            raise _UncertainError

    @property
    def exhausted(self) -> bool:
        return self.work > MAX_WORK

    def regions(self, path: str) -> list[str]:
        """The regions of a parallel state."""
        if path not in self._regions:
            states = self.machine.states
            self._regions[path] = [c for c in states[path].children if states[c].kind is not StateKind.HISTORY]
        return self._regions[path]

    def is_heard(self, region: str, event: str) -> bool:
        """Whether an event selects a transition of any state in a region."""
        if (region, event) not in self._heard:
            rows, _ = self._in(region)
            self.spend(len(rows) // TRANSITIONS_PER_WORK)
            self._heard[region, event] = any(_selects(row, event) for row in rows)
        return self._heard[region, event]

    def speaks_at_exit(self, region: str) -> bool:
        """Whether an `exit` of any state in a region raises or sends an event."""
        return self._in(region)[1]

    def _in(self, region: str) -> tuple[list[Transition], bool]:
        """The transitions of all states in a region that an event selects, and whether an exit there speaks."""
        if region not in self._inside:
            rows, speaks, waiting = list[Transition](), False, [region]
            while waiting:
                state = self.machine.states[waiting.pop()]
                waiting.extend(state.children)
                rows += (t for t in state.transitions if t.event and not t.timed)
                speaks = speaks or _speaks(state.exit)
            self._inside[region] = rows, speaks
        return self._inside[region]

    def rows(self, path: str, event: str) -> list[Transition]:
        """The transitions of a state that an event selects."""
        if (path, event) not in self._rows:
            transitions = self.machine.states[path].transitions
            self.spend(len(transitions) // TRANSITIONS_PER_WORK)
            self._rows[path, event] = [row for row in transitions if _selects(row, event)]
        return self._rows[path, event]

    def timers(self, path: str) -> list[Transition]:
        """Each `after: 0s` of a state."""
        if path not in self._timers:
            rows = reversed(self.machine.states[path].transitions)
            names = {t.event: t for t in rows if t.timed and t.delay == 0}
            self._timers[path] = list(reversed(names.values()))
        return self._timers[path]

    def is_left_at_once(self, path: str) -> bool:
        """Whether an `after: 0s` of a state has a target."""
        if path not in self._left:
            self._left[path] = any(t.delay == 0 and t.targets for t in self.machine.states[path].transitions)
        return self._left[path]

    def domain(self, transition: Transition) -> str:
        """The state that a transition does not leave."""
        if id(transition) not in self._domains:
            self._domains[id(transition)] = _domain(self.machine, transition)
        return self._domains[id(transition)]

    def final(self, path: str) -> list[str]:
        """The final states among a state and its children."""
        if path not in self._final:
            states = self.machine.states
            self._final[path] = [p for p in (*states[path].children, path) if states[p].kind is StateKind.FINAL]
        return self._final[path]


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
                regions = self.survey.regions(outer)
                self.survey.spend(len(regions) // STATES_PER_WORK)
                self.unknown.update(regions)
                self.unknown.discard(path)
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
                raise _UncertainError
            self.active.add(state.path)
            self.timers += self.survey.timers(state.path)
            self._note(state.entry)
            if state.kind is StateKind.FINAL:
                self._end(state)

    def step(self) -> bool:
        """Take the enabled transitions, or those of the next event; return False if the machine rests, or is over."""
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
            self.survey.spend(len(kept) // STATES_PER_WORK)
            rivals = [other for other in kept if self._conflict(transition, other)]
            if all(transition.source != o.source and within(transition.source, o.source) for o in rivals):
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
        return within(inner, outer) or within(outer, inner)

    def _leave(self, domain: str) -> None:
        self.survey.spend((len(self.active) + len(self.unknown) + len(self.timers)) // STATES_PER_WORK)
        leaving = self._in_order(path for path in self.active if path != domain and within(path, domain))
        for state in reversed(leaving):
            self._note(state.exit)
        left = {state.path for state in leaving}
        self.active -= left
        self.begun -= left
        self.timers = [timer for timer in self.timers if isinstance(timer, str) or timer.source not in left]
        regions = {region for region in self.unknown if within(region, domain)}
        if any(map(self.survey.speaks_at_exit, regions)):
            raise _UncertainError
        self.unknown -= regions

    def _begin(self) -> None:
        """Begin each `do`, up to its first action that takes time, and each invoked behaviour."""
        for state in [s for s in self._in_order(self.active) if s.path not in self.begun]:
            self.begun.add(state.path)
            for invoke in state.invoke:
                self.survey.spend(1)
                other = self.machine.invoked.get(invoke.behavior)
                if other is None:
                    raise _UncertainError
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
            self.survey.spend(len(self.survey.regions(path)) // STATES_PER_WORK)
            return all(map(self._is_final, self.survey.regions(path)))
        return not self.active.isdisjoint(self.survey.final(path))

    def selected(self, event: str) -> list[Transition]:
        """The first transition of each innermost state that the event selects."""
        states, found, asked = self.machine.states, list[Transition](), set[str]()
        self.survey.spend(len(self.unknown) // STATES_PER_WORK)
        if event and any(self.survey.is_heard(region, event) for region in self.unknown):
            raise _UncertainError
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
                case _ if _speaks((step,)):
                    raise _UncertainError

    def _in_order(self, paths: Iterable[str]) -> list[State]:
        return [self.machine.states[path] for path in sorted(paths, key=self.survey.order.__getitem__)]


def check(draft: ProjectDraft) -> None:
    """Report chains that never come to rest."""
    ends: dict[tuple[int, int], bool | None] = {}
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        told: set[int] = set()
        for chain in _beginnings(_Survey(machine, ends)):
            if (around := _round(chain)) and told.isdisjoint(id(t) for t, _ in around):
                told.update(id(t) for t, _ in around)
                _report(machine, around, _asked(chain, len(around)), report)


def _beginnings(survey: _Survey) -> Iterator[_Chain]:
    """Yield a chain for each transition of a state in which the machine may rest, and one for its beginning.

    There are no more after MAX_WORK.
    """
    stays: dict[str | None, bool] = {None: True}
    for state in survey.machine.states.values():  # each after the one around it
        stays[state.path] = stays[state.parent] and _stays(survey, state)
        for transition in state.transitions if stays[state.path] else ():
            if survey.exhausted:
                return
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
        if any(map(survey.is_left_at_once, chain.active)):
            return False  # a state around is left at once
        chain.enter((state.path,), state.parent)
        for _ in range(MAX_STEPS_TO_REST):
            if not chain.step():
                return state.path in chain.active
    except _UncertainError:
        return True
    return False


def _round(chain: _Chain) -> list[_Taken]:
    """The transitions of a round back to a situation, or without end; empty if the chain rests or is uncertain."""
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
    except _UncertainError:
        return []
    if not chain.taken:
        return []  # more events wait than are followed, and none selects a transition
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


def _is_over_at_once(machine: MachineDefinition, depth: int, ends: dict[tuple[int, int], bool | None]) -> bool:
    """Whether an invoked behaviour ends as soon as it begins; raises _UncertainError if that is not certain."""
    key = id(machine), depth
    if key not in ends:
        try:
            ends[key] = _ends(machine, depth, ends)
        except _UncertainError:
            ends[key] = None
    if (over := ends[key]) is None:
        raise _UncertainError
    return over


def _ends(machine: MachineDefinition, depth: int, ends: dict[tuple[int, int], bool | None]) -> bool:
    if any(_speaks((*s.entry, *s.do, *s.exit), PARENT) for s in machine.states.values()):
        raise _UncertainError
    chain = _Chain(_Survey(machine, ends), depth)
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
    message, code = "this loop never ends", ENDLESS_CHAIN
    hint = "add a step that takes time, such as `after: {1s: …}`, or give one of these transitions a `guard`"
    if asked:
        message += f" while {' and '.join(f'`{shown}`' for shown in asked)} {'are' if len(asked) > 1 else 'is'} false"
        hint = "change a value that the guard checks, or add a step that takes time"
    if not any(event for _, event in rows):
        code = ALWAYS_LOOP if asked else ENDLESS_ALWAYS
        if not any(t.targets for t, _ in rows):
            hint = "give it a `target`, or move its actions to `entry`"
    related = [(t.where, "then here") for t, _ in rows[1:]]
    report(code, rows[0][0].where, f"{message}: {ways}", hint, related=related)


def _way(event: str) -> str:
    if not event:
        return "`always`"
    return "`after: 0s`" if event.startswith("after.") else f"`{event}`"
