"""The compiled tree of states and transitions that the algorithm of SCXML's Appendix D walks."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import Scope, compile_guard
from lumen.language.actions import Template
from lumen.language.diagnostics import NodePath
from lumen.language.hours import Schedule
from lumen.language.machines import Invoke, MachineDefinition, State, StateKind, Transition
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.action_context import ActionContext
from lumen.statechart.blocks import CompiledBlock, compile_block, compile_delay, compile_value
from lumen.statechart.do_actions import CompiledAction, compile_do
from lumen.statechart.hears import RowBlock
from lumen.statechart.type_checks import type_checks

CompiledGuard = Callable[[Scope], bool]


class CompiledInvoke(NamedTuple):
    """A behaviour that a state invokes."""

    id: str
    """The id of the invoke."""
    behavior: str
    """The name of the behaviour."""
    input: Callable[[Scope], Mapping[str, Any]]
    """Computes the initial values of the behaviour's context."""
    where: NodePath


class ComputedAfter(NamedTuple):
    """An `after` whose delay is computed when its state is entered."""

    delay: Template
    length: Callable[[ActionContext], float]
    """Computes the delay [s]; raises ActionError if it is not a duration."""
    where: NodePath


class StateNode:
    """A compiled state with links to its neighbours; compared by identity."""

    __slots__ = (
        "afters", "ancestors", "children", "computed", "do", "entry", "exit", "histories", "index", "initial",
        "invokes", "kind", "name", "output", "parent", "path", "schedules", "state", "transitions", "views",
    )  # fmt: skip

    def __init__(self, state: State | None, index: int, parent: "StateNode | None") -> None:
        self.state = state
        self.index = index
        """The position of the state in document order; -1 for the document."""
        self.parent = parent
        self.path = state.path if state else ""
        self.name = state.name if state else ""
        self.kind = state.kind if state else StateKind.COMPOUND
        self.ancestors: tuple[StateNode, ...] = (parent, *parent.ancestors) if parent else ()
        """Innermost first, with the document at the end."""
        self.children: list[StateNode] = []
        self.histories: list[StateNode] = []
        """The history states among its children, which `children` does not have."""
        self.initial: tuple[StateNode, ...] = ()
        self.transitions: tuple[CompiledTransition, ...] = ()
        """Its transitions, in the order of evaluation."""
        self.afters: tuple[tuple[str, int], ...] = ()
        """The events of its `after` transitions with constant delays, each with its delay [ns]."""
        self.computed: Mapping[str, ComputedAfter] = {}
        """The `after` transitions with computed delays, by event."""
        self.schedules: Mapping[str, Schedule] = {}
        """The times of its `at` transitions, by event."""
        self.entry: CompiledBlock = compile_block(state.entry) if state else ()
        self.exit: CompiledBlock = compile_block(state.exit) if state else ()
        self.do: tuple[CompiledAction, ...] = compile_do(state.do) if state else ()
        self.invokes: tuple[CompiledInvoke, ...] = tuple(map(_invoke, state.invoke)) if state else ()
        self.views: dict[tuple[str, str], Mapping[str, str]] = {}
        self.output = compile_value(state.output) if state and state.output is not None else None

    @property
    def busy(self) -> bool:
        """Return True if entering the state starts a `do`, an invocation or a timer, which leaving it must end."""
        return bool(self.do or self.invokes or self.timed)

    @property
    def timed(self) -> bool:
        """Return True if the state has timers: `after` or `at` transitions."""
        return bool(self.afters or self.computed or self.schedules)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name or 'root'}>"

    def view(self, language: str, place: str) -> Mapping[str, str]:
        """Return the value that expressions of the state read as `state`."""
        found = self.views.get((language, place))
        if found is None:
            found = self.views[language, place] = {"path": self.path, "language": language, "place": place}
        return found

    def lies_below(self, other: "StateNode") -> bool:
        """Return True if the state is a proper descendant of the other (`isDescendant`)."""
        return other in self.ancestors

    def below(self, top: "StateNode") -> Iterator["StateNode"]:
        """Yield the proper ancestors, innermost first, up to but not including `top` (`getProperAncestors`)."""
        for ancestor in self.ancestors:
            if ancestor is top:
                return
            yield ancestor


class CompiledTransition:
    """A transition with compiled guard and actions; compared by identity."""

    __slots__ = ("alone", "block", "definition", "guard", "late", "rows", "source", "targets", "where")

    def __init__(self, definition: Transition, source: StateNode, targets: tuple[StateNode, ...]) -> None:
        self.definition = definition
        self.source = source
        self.targets = targets
        guard = definition.guard
        self.guard: CompiledGuard | None = compile_guard(guard.source) if guard else None
        self.late: CompiledGuard | None = None
        """For a row of `hears`, the guard that decides if no state has reacted otherwise."""
        self.rows: RowBlock | None = None
        """For a row of `hears`, all rows of its state."""
        self.where = guard.where if guard else definition.where
        self.block: CompiledBlock = compile_block(definition.actions)
        self.alone = (self,)
        """The tuple with only this transition."""

    @property
    def is_otherwise(self) -> bool:
        """Return True for an `else` row, which can only be taken late."""
        hears = self.definition.hears
        return hears is not None and hears.way == "else"

    def matches(self, name: str) -> bool:
        """Return True if an event of that name selects the transition (SCXML 3.12.1); never for `after` and `at`."""
        event = self.definition.event
        if self.definition.timed or not event:
            return False
        if self.definition.exact:
            return event == name
        prefix = event.removesuffix(".*")
        return event == "*" or name == prefix or name.startswith(prefix + ".")


class Chart:
    """All nodes of a machine; `document` is the implicit `<scxml>` element around the root."""

    def __init__(self, definition: MachineDefinition) -> None:
        self.definition = definition
        self.document = StateNode(None, -1, None)
        self.nodes: dict[str, StateNode] = {}
        for index, state in enumerate(definition.states.values()):
            parent = self.document if state.parent is None else self.nodes[state.parent]
            node = self.nodes[state.path] = StateNode(state, index, parent)
            (parent.histories if node.kind is StateKind.HISTORY else parent.children).append(node)
        self.root = self.nodes[""]
        self.document.initial = (self.root,)
        self.by_name = {node.name: node for node in self.nodes.values() if node is not self.root}
        self.has_history = any(node.histories for node in self.nodes.values())
        self.checks = type_checks(definition)
        for node in self.nodes.values():
            self._connect(node)
        self._guard_rows()

    def _guard_rows(self) -> None:
        """Set the guards of all rows of `hears`, which depend on the other rows of the same state, and sort them.

        A state with rows evaluates them after its transitions of `on`, but before one on any event (`*`).
        """
        for node in self.nodes.values():
            rows = {t.definition.hears.number: t for t in node.transitions if t.definition.hears}
            if rows:
                block = RowBlock(self.definition, {number: row.guard for number, row in rows.items()})
                for number, row in rows.items():
                    row.rows, (row.guard, row.late) = block, block.guards(number)
                order = sorted(node.transitions, key=lambda t: 2 if t.definition.event == "*" else t.rows is not None)
                node.transitions = tuple(order)

    def _connect(self, node: StateNode) -> None:
        assert node.state is not None  # only the document lacks a state, and it is not among the nodes
        node.initial = tuple(self.nodes[path] for path in node.state.initial)
        node.transitions = tuple(
            CompiledTransition(t, node, tuple(self.nodes[path] for path in t.targets)) for t in node.state.transitions
        )
        node.afters = tuple(
            {t.event: nanoseconds(t.delay) for t in node.state.transitions if isinstance(t.delay, float)}.items()
        )
        node.computed = {
            t.event: ComputedAfter(t.delay, compile_delay(t.delay), t.delay.where)
            for t in node.state.transitions
            if isinstance(t.delay, Template)
        }
        node.schedules = {t.event: t.schedule for t in node.state.transitions if t.schedule}


def _invoke(invoke: Invoke) -> CompiledInvoke:
    return CompiledInvoke(invoke.id, invoke.behavior, compile_value(invoke.input), invoke.where)
