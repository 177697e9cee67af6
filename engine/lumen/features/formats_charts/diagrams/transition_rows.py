"""What leads on from a state, as a person reads it: `hears dance → dance`, `after 30 s → goodbye`."""

from collections.abc import Iterator, Mapping, Sequence

from lumen.expressions import ExpressionError, parse_expression, unparse
from lumen.expressions.tree import Binary, ExpressionNode, FunctionCall, Literal, Logic
from lumen.language.actions import Expression
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition, State, StateKind, Transition

MAX_ROW = 46
"""How many characters of a row are shown."""
AGAIN = "again"


def rows_of(machine: MachineDefinition, state: State, only: str = "") -> Iterator[str]:
    """A row for each target, with everything that leads there; with `only` those that lead to that state's path."""
    by_target: dict[str, list[str]] = {}
    seen: set[str] = set()
    for transition in (t for t in state.transitions if not made(t.where)):
        awaited = transition.hears.title if transition.hears else transition.event
        cause = trigger(transition, after_others=awaited in seen)
        if transition.guard:
            seen.add(awaited)
        for target in transition.targets:
            if not only or target == only:
                causes = by_target.setdefault(target, [])
                causes += [cause] if cause not in causes else []
    for target, causes in by_target.items():
        yield from _lines(causes, AGAIN if target == state.path else _goal(machine, target))


def trigger(transition: Transition, *, after_others: bool = False) -> str:
    """What takes a transition; `after_others` of the same event with guards it is what is left."""
    event = transition.caption("failed")
    guard = guard_phrase(transition.guard) if transition.guard else ""
    if guard.startswith("“") and not transition.hears:
        return guard
    if guard:
        return f"{event} if {guard}".strip()
    return f"otherwise {event or 'at once'}" if after_others else event or "at once"


def made(where: NodePath) -> bool:
    """Whether something was made of a `for`: nobody wrote it."""
    return where[-1:] == ("for",)


def guard_phrase(guard: Expression) -> str:
    """A guard as a person reads it: what has to be heard in quotes, everything else as the author wrote it."""
    try:
        return _phrase(parse_expression(guard.shown)) or " ".join(guard.shown.split())
    except ExpressionError:
        return " ".join(guard.shown.split())


def _phrase(node: ExpressionNode) -> str:
    match node:
        case FunctionCall("heard", (_, Literal(value=str() as phrase))):
            return f"“{phrase}”"
        case FunctionCall("heard", (_, table)):
            return f"“…” in {unparse(table)}"
        case Binary("!=", FunctionCall("lookup", (_, Literal(value=str() as name))), Literal(value=None)):
            return f"“…” in {name}"
        case Binary("!=", FunctionCall("after", (_, Literal(value=str() as words))), Literal(value="")):
            return f"“{words} …”"
        case Logic("||", operands):
            phrases = [_phrase(operand) for operand in operands]
            return " or ".join(phrases) if all(phrases) else ""
    return ""


def short_name(states: Mapping[str, State], path: str) -> str:
    """The end of a path."""
    return path.rpartition(".")[2] or states[path].alias or "the whole"


def _goal(machine: MachineDefinition, path: str) -> str:
    state = machine.states[path]
    if state.kind is StateKind.HISTORY:
        return f"back in {short_name(machine.states, state.parent or '')}"
    return short_name(machine.states, path)


def _lines(causes: Sequence[str], goal: str) -> Iterator[str]:
    """As many causes on a line as fit, and the goal at the end of the last."""
    line = ""
    for number, cause in enumerate(causes):
        shown = cause if len(cause) <= MAX_ROW else f"{cause[: MAX_ROW - 1].rstrip()}…"
        end = f" → {goal}" if number == len(causes) - 1 else ","
        if line and len(f"{line} {shown}{end}") > MAX_ROW:
            yield line
            line = ""
        line = f"{line} {shown}{end}".strip()
    yield line
