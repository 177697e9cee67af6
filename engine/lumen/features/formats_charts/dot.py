"""Writes a machine as a Graphviz graph, with states as boxes and regions as dashed clusters."""

from collections.abc import Iterator

from lumen.language.machines import Invoke, MachineDefinition, State, StateKind, Transition, is_within
from lumen.run.captions import caption, invocation

_HEAD = """\
digraph {
  compound=true; rankdir=TB; fontname="Helvetica"
  node [shape=box, style=rounded, fontname="Helvetica", fontsize=11]
  edge [fontname="Helvetica", fontsize=9]"""


def dot(machine: MachineDefinition) -> str:
    """Return the graph in Graphviz's DOT language, ending with a newline.

    A state with inner states is a cluster, and its arrows end at the cluster's frame. An invoked behaviour is drawn
    once, as a dashed cluster inside its state; further invocations are boxes with its name.
    """
    return "\n".join([_HEAD, *_DotDrawing(machine).lines(), "}"]) + "\n"


class _DotDrawing:
    """Generates the lines for one machine; its states have the ids `s0`, `s1`, … in document order."""

    def __init__(self, machine: MachineDefinition, prefix: str = "", drawn: set[str] | None = None) -> None:
        self.machine = machine
        self.drawn = set() if drawn is None else drawn
        self.ids = {path: f"{prefix}s{number}" for number, path in enumerate(machine.states)}

    def lines(self, name: str = "") -> Iterator[str]:
        """Yield the machine's lines; `name` labels an invoked machine, and is empty for the outermost one."""
        yield from self._cluster(self.machine.root, 1, name)
        for state in self.machine.states.values():
            for transition in state.transitions:
                yield from self._arrows(transition)

    def _cluster(self, state: State, depth: int, name: str = "") -> Iterator[str]:
        indent = "  " * depth
        within = [s for s in self.machine.states.values() if s.parent == state.path and s.path]
        parent = self.machine.states[state.parent] if state.parent is not None else None
        look = "dashed" if name or (parent and parent.kind is StateKind.PARALLEL) else "rounded"
        yield f"{indent}subgraph cluster_{self.ids[state.path]} {{"
        yield f"{indent}  label={_quoted(name or _label(state, self.machine))}; style={look}"
        yield f"{indent}  {self.ids[state.path]} [shape=point, style=filled, width=0.1]"
        for child in within:
            framed = child.children or child.invoke
            yield from self._cluster(child, depth + 1) if framed else self._box(child, depth + 1)
        for number, invoke in enumerate(state.invoke):
            yield from self._inside(invoke, f"{self.ids[state.path]}i{number}", depth + 1)
        for path in state.initial:
            yield self._arrow(state.path, path, "", begins=True)
        yield f"{indent}}}"

    def _inside(self, invoke: Invoke, id: str, depth: int) -> Iterator[str]:
        """Yield the lines for an invoked behaviour: a cluster, or only a box if it is unknown or already drawn."""
        indent, machine = "  " * depth, self.machine.invoked.get(invoke.behavior)
        if machine is None or invoke.behavior in self.drawn:
            yield f"{indent}{id} [label={_quoted(invocation(invoke))}, style=dashed]"
            return
        self.drawn.add(invoke.behavior)
        yield from (f"{indent}{line}" for line in _DotDrawing(machine, id, self.drawn).lines(invocation(invoke)))

    def _box(self, state: State, depth: int) -> Iterator[str]:
        shape = ""
        if state.kind is StateKind.FINAL:
            shape = ", peripheries=2"
        elif state.kind is StateKind.HISTORY:
            shape = ", shape=circle"
        yield f"{'  ' * depth}{self.ids[state.path]} [label={_quoted(_label(state, self.machine))}{shape}]"

    def _arrows(self, transition: Transition) -> Iterator[str]:
        for target in transition.targets or (transition.source,):
            style = "" if transition.targets else ", style=dotted"
            yield self._arrow(transition.source, target, f"label={_quoted(caption(transition))}{style}")

    def _arrow(self, source: str, target: str, look: str, *, begins: bool = False) -> str:
        """Return an arrow, clipped at the frame of each cluster that does not contain its other end."""
        looks = [look] if look else []
        for end, path, other in (("ltail", source, target), ("lhead", target, source)):
            holds = is_within(other, path)
            framed = self.machine.states[path].children or self.machine.states[path].invoke
            if framed and not holds and not begins:
                looks.append(f"{end}=cluster_{self.ids[path]}")
        shown = f" [{', '.join(looks)}]" if looks else ""
        return f"  {self.ids[source]} -> {self.ids[target]}{shown}"


def _label(state: State, machine: MachineDefinition) -> str:
    if state.kind is StateKind.HISTORY:
        return "H*" if state.deep else "H"
    return state.path.rpartition(".")[2] or machine.id or "behaviour"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
