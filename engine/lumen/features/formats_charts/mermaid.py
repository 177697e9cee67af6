"""Writes a machine as a `stateDiagram-v2` for Mermaid 11, with nested states and regions side by side."""

import re
from collections.abc import Iterator

from lumen.language.machines import Invoke, MachineDefinition, State, StateKind, Transition
from lumen.run.captions import caption, invocation

_SPECIAL = re.compile(r"[^\w .,!?()=+*/&|\'\[\]…-]|--+|\b_+")


def mermaid(machine: MachineDefinition) -> str:
    """Return the diagram's text, ending with a newline.

    States have the ids `s0`, `s1`, … in document order and their keys as labels, since Mermaid accepts few characters
    in an id. If a state has no children, its label also lists transitions without a target. An invoked behaviour is
    drawn once, as a region inside its state; further invocations are boxes with its name.
    """
    return "\n".join(["stateDiagram-v2", *_MermaidDrawing(machine).lines()]) + "\n"


class _MermaidDrawing:
    """Generates the lines for one machine, with each arrow in the innermost compound state that contains both ends."""

    def __init__(self, machine: MachineDefinition, prefix: str = "", drawn: set[str] | None = None) -> None:
        self.machine, self.prefix = machine, prefix
        self.drawn = set() if drawn is None else drawn
        self.ids = {path: f"{prefix}s{number}" for number, path in enumerate(machine.states)}
        self.arrows: dict[str, list[str]] = {}
        self.framed = machine.root.kind is StateKind.PARALLEL
        for transition in (t for state in machine.states.values() for t in state.transitions):
            for target in transition.targets:
                self._arrow(transition, target)

    def lines(self) -> Iterator[str]:
        root = self.machine.root
        self.framed = self.framed or bool(root.invoke)
        if self.framed:
            yield from self._box(root, 1)
            yield from (f"  {arrow}" for arrow in self.arrows.get("", ()))
        else:
            yield from self._body(root, 1)

    def _arrow(self, transition: Transition, target: str) -> None:
        self.framed = self.framed or not transition.source or not target
        line = f"{self.ids[transition.source]} --> {self.ids[target]}{_caption(transition)}"
        self.arrows.setdefault(self._home(transition.source, target), []).append(line)

    def _home(self, one: str, other: str) -> str:
        states = self.machine.states
        home = states[one].parent
        while home and not (other.startswith(f"{home}.") and states[home].kind is StateKind.COMPOUND):
            home = states[home].parent
        return home or ""

    def _state(self, state: State, depth: int) -> Iterator[str]:
        if state.children or state.invoke:
            yield from self._box(state, depth)
            return
        indent, id = "  " * depth, self.ids[state.path]
        yield f'{indent}state "{_label(state)}" as {id}'
        if state.kind is StateKind.FINAL:
            yield f"{indent}{id} --> [*]"

    def _box(self, state: State, depth: int) -> Iterator[str]:
        indent = "  " * depth
        yield f'{indent}state "{_label(state)}" as {self.ids[state.path]} {{'
        yield from self._body(state, depth + 1)
        yield f"{indent}}}"

    def _body(self, state: State, depth: int) -> Iterator[str]:
        indent = "  " * depth
        for number, child in enumerate(state.children):
            if number and state.kind is StateKind.PARALLEL:
                yield f"{indent}--"
            yield from self._state(self.machine.states[child], depth)
        for path in state.initial:
            yield f"{indent}[*] --> {self.ids[path]}"
        if state.path or not self.framed:
            yield from (f"{indent}{arrow}" for arrow in self.arrows.get(state.path, ()))
        for number, invoke in enumerate(state.invoke):  # after the arrows, which belong to the region before
            if number or state.children:
                yield f"{indent}--"
            yield from self._inside(invoke, f"{self.ids[state.path]}i{number}", depth)

    def _inside(self, invoke: Invoke, id: str, depth: int) -> Iterator[str]:
        """Yield the lines for an invoked behaviour: a box with its states, or only its name if unknown or drawn."""
        indent, machine = "  " * depth, self.machine.invoked.get(invoke.behavior)
        name = _escaped(invocation(invoke))
        if machine is None or invoke.behavior in self.drawn:
            yield f'{indent}state "{name}" as {id}'
            return
        self.drawn.add(invoke.behavior)
        yield f'{indent}state "{name}" as {id} {{'
        yield from (f"{indent}{line}" for line in _MermaidDrawing(machine, id, self.drawn).lines())
        yield f"{indent}}}"


def _label(state: State) -> str:
    key = state.path.rpartition(".")[2] or state.alias or "behaviour"
    if state.kind is StateKind.HISTORY:
        key = f"{key} (H*)" if state.deep else f"{key} (H)"
    inner = [_caption(t).removeprefix(" : ") for t in state.transitions if not t.targets and not state.children]
    return _escaped(key) + "".join(f"<br/>{line}" for line in inner)


def _caption(transition: Transition) -> str:
    """Return an arrow's label, ` : event [guard]`, or empty without an event and a guard."""
    text = caption(transition)
    return f" : {_escaped(text)}" if text else ""


def _escaped(text: str) -> str:
    """Return the text with Mermaid's special characters as entities, such as `#58;` for a colon."""
    return _SPECIAL.sub(lambda found: "".join(f"#{ord(c)};" for c in found[0]), text)
