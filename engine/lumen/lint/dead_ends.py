"""Checks for states without a way out, without a way back, or without a time limit."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from lumen.language.actions import Raise, Send, nested
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.machines import MachineDefinition, State, StateKind, Transition, is_within
from lumen.lint.endless_chains import ENDLESS_CHAIN
from lumen.lint.statecharts import ALWAYS_LOOP, reachable
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.transitions import ENDLESS_ALWAYS

DEAD_END = Code("dead-end", "statecharts", WARNING, "no transition leads out of a state")
NO_WAY_BACK = Code("no-way-back", "statecharts", WARNING, "no transitions lead back from a state to the initial state")
HISTORY_OF_END = Code(
    "history-of-end", "statecharts", WARNING, "a transition leads to a history that remembers a final state"
)
WAITS_FOR_EVER = Code("waits-for-ever", "statecharts", WARNING, "a state is left only if a visitor does something")
LEFT_BY_ALARM = Code("left-by-alarm", "statecharts", WARNING, "a state is left only when something is wrong")

TROUBLES = ("fallen", "stop", "battery.low", "motors.hot", "brain.lost", "robot.lost")
"""Events about a fault of the robot.

A region that waits for one is a watching region; events that it raises are alarms.
"""


GraphNode = tuple[str, str]
"""A node of the graph: a relation and the path of a state.

`in` is being in the state, `to` entering it, and `any` being in any state below it.
"""

_RESTLESS = (ENDLESS_ALWAYS, ALWAYS_LOOP, ENDLESS_CHAIN)


def check(draft: ProjectDraft) -> None:
    """Report states that the robot may never leave, in files that were read as a whole and have no endless loops."""
    events = {r.event for r in draft.settings.routes.values() if r.event} if draft.settings else set[str]()
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        if report.whole and not any(d.code in _RESTLESS for d in report.diagnostics):
            _Ways(machine, report, events).check()
            _ended(machine, report)


def _ended(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report transitions to the history of a parent from the state to which the parent's `done.state` leads.

    Such a history remembers the final state, so the parent ends again immediately.
    """
    for path, state in machine.states.items():
        parent = machine.states[state.parent] if state.parent is not None else None
        if state.kind is not StateKind.HISTORY or parent is None:
            continue
        if not any(machine.states[child].kind is StateKind.FINAL for child in parent.children):
            continue
        done = [t for t in parent.transitions if t.event == f"done.state.{parent.name}" and t.targets]
        for transition in (t for d in done for target in d.targets for t in machine.states[target].transitions):
            if path in transition.targets:
                message = (
                    f"`{path}` remembers the final state of `{parent.name}`, so `{parent.name}` ends again at once"
                )
                hint = f"go to `{parent.name}` itself to restart it"
                related = [(done[0].where, "its end is handled here")]
                report(HISTORY_OF_END, transition.where, message, hint, related=related)


@dataclass
class _Graph:
    """The possible moves between the states of a machine; guards are assumed to hold."""

    machine: MachineDefinition
    after: dict[GraphNode, list[GraphNode]] = field(default_factory=dict)
    """The nodes to which one move leads from each node."""
    before: dict[GraphNode, list[GraphNode]] = field(default_factory=dict)
    """The nodes from which one move leads to each node."""

    def __post_init__(self) -> None:
        for path, state in self.machine.states.items():
            self.join(("to", path), ("in", path))
            if state.parent is not None:
                self.join(("in", path), ("in", state.parent))
                self.join(("any", state.parent), ("any", path))
            self.join(("any", path), ("in", path))
            for inner in state.children if state.kind is StateKind.PARALLEL else state.initial:
                self.join(("to", path), ("to", inner))
            if state.kind is StateKind.HISTORY and state.parent is not None:
                self.join(("to", path), ("any", state.parent))
            for transition in state.transitions:
                for target in transition.targets:
                    self.go(path, target)

    def join(self, one: GraphNode, other: GraphNode) -> None:
        self.after.setdefault(one, []).append(other)
        self.before.setdefault(other, []).append(one)

    def go(self, source: str, target: str) -> None:
        """Add a transition: it also leaves the regions next to its source, and enters those next to its target."""
        self.join(("in", source), ("to", target))
        for path in self.above(source):
            if self.machine.states[path].kind is StateKind.PARALLEL and not is_within(target, path):
                self.join(("in", path), ("to", target))
        for path in self.above(target):
            state = self.machine.states[path]
            if state.kind is StateKind.PARALLEL and not is_within(source, path):
                for child in state.children:
                    if not is_within(target, child):
                        self.join(("in", source), ("to", child))

    def above(self, path: str) -> Iterator[str]:
        parent = self.machine.states[path].parent
        while parent is not None:
            yield parent
            parent = self.machine.states[parent].parent


def spread(begin: Iterable[GraphNode], moves: dict[GraphNode, list[GraphNode]]) -> set[GraphNode]:
    """Return the nodes in `begin`, and all nodes that a sequence of moves reaches from these."""
    found = set(begin)
    waiting = list(found)
    while waiting:
        for node in moves.get(waiting.pop(), ()):
            if node not in found:
                found.add(node)
                waiting.append(node)
    return found


class _Ways:
    """Checks one machine.

    Its `tracks` are its outermost compound states, in each of which one state is active at a time.
    """

    def __init__(self, machine: MachineDefinition, report: DocumentReport, events: set[str]) -> None:
        self.machine, self.report, self.events = machine, report, events
        self.graph = _Graph(machine)
        self.exits: dict[str, list[Transition]] = {}
        self.entered: dict[str, list[Transition]] = {}
        self.alarms: frozenset[str] = frozenset()
        for state in machine.states.values():
            for transition in state.transitions:
                for target in transition.targets:
                    self.entered.setdefault(target, []).append(transition)

    def check(self) -> None:
        root = self.machine.root
        found, ranks = reachable(self.machine), {path: i for i, path in enumerate(self.machine.states)}
        tracks = [root] if root.kind is StateKind.COMPOUND else [self.machine.states[p] for p in root.children]
        watching = {track.path for track in tracks if len(tracks) > 1 and self.watches(track)}
        raised = {track.path: self.raised(track) for track in tracks}
        self.alarms = frozenset(name for path in watching for name in raised[path]) - {
            name for path in raised.keys() - watching for name in raised[path]
        }
        for track in tracks:
            below = set(self.below(track)) & found
            order = sorted(below, key=ranks.__getitem__)
            self.track(track, [path for path in order if self.machine.states[path].kind is StateKind.ATOMIC])

    def track(self, track: State, leaves: list[str]) -> None:
        home = track
        while home.kind is StateKind.COMPOUND and home.initial:
            home = self.machine.states[home.initial[0]]
        others = [path for path in leaves if path != home.path]
        dead = dict.fromkeys(path for path in others if not any(self.ways_out(path)))
        for path in dead:
            self.dead_end(path)
        stuck = [p for p in others if p not in dead and all(self.is_alarm(p, t) for t in self.ways_out(p))]
        for path in stuck:
            state = self.machine.states[path]
            names = " or ".join(f"`{name}`" for name in sorted({t.event for t in self.ways_out(path)}))
            message = f"`{state.name}` is left only when something is wrong ({names})"
            hint = "give it `onDone:`, `after: {30s: …}` or another transition"
            self.report(LEFT_BY_ALARM, state.where, message, hint, key=True)
        dead.update(dict.fromkeys(stuck))
        back = spread([("in", home.path)], self.graph.before)
        if any(("in", path) in back for path in others) or home.path.rpartition(".")[2] == "idle":
            self.lost(track, home, [p for p in others if ("in", p) not in back], dead)
        for path in others:
            if path not in dead:
                self.waiting(self.machine.states[path])

    def watches(self, track: State) -> bool:
        """Return whether a state of a track waits for a fault of the robot."""
        states = [track, *(self.machine.states[path] for path in self.below(track))]
        return any(t.event in TROUBLES and t.targets for state in states for t in state.transitions)

    def raised(self, track: State) -> set[str]:
        """Return the events that a track raises."""
        inside = {track.path, *self.below(track)}
        sites = (site for site in action_sites(self.machine) if site.state.path in inside)
        return {site.step.action.event for site in sites if isinstance(site.step.action, Raise)}

    def is_alarm(self, path: str, transition: Transition) -> bool:
        """Return whether a transition of an outer state reacts to an alarm."""
        return transition.source != path and (transition.event in self.alarms or transition.event in TROUBLES)

    def ways_out(self, path: str) -> Iterator[Transition]:
        """Yield the transitions by which an atomic state can be left: its own and those of its ancestors."""
        state: State | None = self.machine.states[path]
        while state is not None:
            yield from (t for t in state.transitions if any(target != path for target in t.targets))
            if state.kind is StateKind.PARALLEL:
                yield from self.leaving(state)
            state = self.machine.states[state.parent] if state.parent is not None else None

    def leaving(self, parallel: State) -> list[Transition]:
        """Return the transitions below a parallel state that lead out of it: each leaves all regions of the state."""
        if parallel.path not in self.exits:
            self.exits[parallel.path] = [
                transition
                for path in self.below(parallel)
                for transition in self.machine.states[path].transitions
                if any(not is_within(target, parallel.path) for target in transition.targets)
            ]
        return self.exits[parallel.path]

    def below(self, state: State) -> Iterator[str]:
        """Yield the paths of all descendants of a state."""
        waiting = list(state.children)
        while waiting:
            yield (path := waiting.pop())
            waiting.extend(self.machine.states[path].children)

    def from_where(self, path: str) -> list[tuple[NodePath, str]]:
        """Return the related place of the only transition that enters a state; empty if there is none, or several."""
        ways = self.entered.get(path, [])
        return [(ways[0].where, "it is entered only from here")] if len(ways) == 1 else []

    def dead_end(self, path: str) -> None:
        state = self.machine.states[path]
        hint = "give it a transition, or `type: final` if the behaviour ends there"
        message = f"no transition leads out of `{state.name}`: the behaviour would stay there for ever"
        self.report(DEAD_END, state.where, message, hint, key=True, related=self.from_where(path))

    def lost(self, track: State, home: State, lost: list[str], dead: Iterable[str]) -> None:
        """Report states from which no transitions lead to `home`; of connected states, report only the first."""
        ends = [("in", path) for path in dead]
        ends += [("in", p) for p in track.children if self.machine.states[p].kind is StateKind.FINAL]
        ended = spread(ends, self.graph.before)
        told: set[GraphNode] = set()
        for path in lost:
            if ("in", path) in ended or ("in", path) in told:
                continue
            told |= spread([("in", path)], self.graph.after)
            told |= spread([("in", path)], self.graph.before)
            state = self.machine.states[path]
            message = f"no transitions lead back from `{state.name}` to the initial state `{home.name}`"
            hint = f"add a transition to `{home.name}`, here or in a later state"
            self.report(NO_WAY_BACK, state.where, message, hint, key=True, related=self.from_where(path))

    def waiting(self, state: State) -> None:
        """Report a state that is left only if a visitor acts."""
        steps = nested((*state.entry, *state.do))
        raised = {  # here: an event that is sent to another behaviour is not
            a.event for step in steps if isinstance(a := step.action, Raise) or (isinstance(a, Send) and not a.to)
        }
        names: set[str] = set()
        for transition in self.ways_out(state.path):
            if self.in_course(transition) and not self.late(state, transition):
                if transition.event in raised or transition.event not in self.events:
                    return
                names.add(transition.event)
        if names:
            heard = " or ".join(f"`{name}`" for name in sorted(names))
            message = f"`{state.name}` waits for {heard} without a time limit"
            hint = "add a time limit for visitors who walk away, such as `after: {30s: …}`"
            self.report(WAITS_FOR_EVER, state.where, message, hint, key=True)

    def in_course(self, transition: Transition) -> bool:
        """Return whether a transition is part of the ordinary course of the behaviour, rather than an outer alarm."""
        source = self.machine.states[transition.source]
        return (
            source.kind is StateKind.ATOMIC
            or not transition.event
            or transition.event in self.events
            or (transition.timed or transition.exact or "*" in transition.event or "error" in transition.event)
        )

    def late(self, state: State, transition: Transition) -> bool:
        """Return whether a transition is the `at` of an outer state: an inner state may have to wait hours for it."""
        within_others = state.parent is not None and state.path not in self.machine.states[state.parent].initial
        return transition.schedule is not None and transition.source != state.path and within_others
