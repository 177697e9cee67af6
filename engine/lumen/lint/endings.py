"""Events of the engine about one state or invoke, such as `done.state.talk`: whether anything can raise them."""

from lumen.language.diagnostics import did_you_mean
from lumen.language.machines import MachineDefinition, State, StateKind

_LACKS = {
    "done.state": "it has no final state",
    "done.do": "it has no `do`",
    "error.do": "it has no `do`",
}
_ANSWERS = ("done.command", "error.command", "cancelled.command")
"""The robot's answers to commands: they go to the `do` that waits for them, never to a transition."""


def ending_fault(machine: MachineDefinition, descriptor: str) -> str:
    """Return a hint that explains why nothing can raise the event of a descriptor; empty if something can."""
    words = descriptor.removesuffix(".*").split(".")
    family, name = ".".join(words[:2]), ".".join(words[2:])
    if family in _ANSWERS:
        return "write `onDone` or `onError` in the state whose `do` gave the command"
    able = _able(machine, family)
    if not name or able is None or any(_begins(name, other) for other in able):
        return ""
    if family in _LACKS and any(name in (state.name, state.path) for state in machine.states.values()):
        return f"`{name}` never ends: {_LACKS[family]}"
    return (
        did_you_mean(f"{family}.{name}", [f"{family}.{other}" for other in able])
        or f"no state or invoke raises `{family}`"
    )


def _begins(descriptor: str, name: str) -> bool:
    return name == descriptor or name.startswith(f"{descriptor}.")


def _able(machine: MachineDefinition, family: str) -> set[str] | None:
    """Return the states or invokes that can raise an event of a family; None for any other family."""
    states = machine.states.values()
    match family:
        case "done.state":
            return {state.name for state in states if _ends(machine, state)}
        case "done.do" | "error.do":
            return {state.name for state in states if state.do}
        case "done.invoke" | "error.invoke":
            return {invoke.id for state in states for invoke in state.invoke}
    return None


def _ends(machine: MachineDefinition, state: State) -> bool:
    """Return whether a state can end (`isInFinalState` of SCXML)."""
    children = [machine.states[path] for path in state.children]
    if state.kind is StateKind.PARALLEL:
        return all(_ends(machine, child) for child in children if child.kind is not StateKind.HISTORY)
    return state.kind is StateKind.FINAL or any(child.kind is StateKind.FINAL for child in children)
