"""Guards that are always or never true, and transitions that are never taken because of an earlier transition."""

from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from lumen.expressions.parser import MAX_REMEMBERED_TREES
from lumen.expressions.tree import ExpressionNode, FunctionCall, Literal, Logic
from lumen.language.actions import Expression
from lumen.language.diagnostics import INFO, WARNING, Code, NodePath
from lumen.language.machines import MachineDefinition, State, StateKind, Transition, is_within
from lumen.lint.events import hears
from lumen.lint.logic import always, implies, never, tree
from lumen.lint.walk import expression_sites
from lumen.lint.word_tables import is_taken
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import memoize

CONSTANT_GUARD = Code("constant-guard", "statecharts", WARNING, "a guard is always true, or never true")
OVERLAPPING_GUARDS = Code(
    "overlapping-guards", "statecharts", INFO, "an earlier guard already matches some of these phrases"
)
SHADOWED_TRANSITION = Code(
    "shadowed-transition", "statecharts", WARNING, "a transition is never taken, because an earlier one always is"
)

MAX_COMPARED_CANDIDATES = 60
"""The maximum number of a state's candidates that are compared with one another; later ones are not checked."""


class HeardCall(NamedTuple):
    """A guard that is a single call `heard(text, name)`."""

    text: ExpressionNode
    name: str


def check(draft: ProjectDraft) -> None:
    """Report constant guards, and candidates that an earlier candidate makes wholly or partly unreachable."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for guard in dict.fromkeys(spot.text for spot in expression_sites(machine) if spot.guard):
            if isinstance(guard, Expression) and not _told(report, guard.where):
                _constant(guard, report)
        for state in machine.states.values():
            if len(state.transitions) > 1:
                _late(machine, state, report)
            if state.children:
                _taken_within(machine, state, report)


def _told(report: DocumentReport, where: NodePath) -> bool:
    """Return whether the text at that path already has a finding."""
    place = report.document.place(where)
    return any(d.place.line == place.line and d.place.column >= place.column for d in report.diagnostics)


def _constant(guard: Expression, report: DocumentReport) -> None:
    if _never(guard.source):
        simple = not isinstance(tree(guard.source), Logic)
        message = (
            "this condition is never true"
            if simple
            else "this condition is never true: its parts contradict each other"
        )
        report(CONSTANT_GUARD, guard.where, message, "check its operators and numbers, or delete what it guards")
    elif _always(guard.source):
        report(CONSTANT_GUARD, guard.where, "this condition is always true", "check its operators, or delete it")


@lru_cache(maxsize=MAX_REMEMBERED_TREES)
def _never(source: str) -> bool:
    return never(tree(source))


@lru_cache(maxsize=MAX_REMEMBERED_TREES)
def _always(source: str) -> bool:
    return always(tree(source))


@lru_cache(maxsize=MAX_REMEMBERED_TREES)
def _implies(source: str, other: str) -> bool:
    return implies(tree(source), tree(other))


def _late(machine: MachineDefinition, state: State, report: DocumentReport) -> None:
    """Report candidates that are never taken, or not for all their phrases, because of an earlier candidate."""
    earlier: list[Transition] = []
    heard = any(transition.hears for transition in state.transitions)
    candidates = sorted(state.transitions, key=_turn) if heard else state.transitions
    for transition in candidates[:MAX_COMPARED_CANDIDATES]:
        if any(_takes_all(other, transition, machine, report) for other in earlier if covers(other, transition)):
            continue
        earlier.append(transition)


def _taken_within(machine: MachineDefinition, state: State, report: DocumentReport) -> None:
    """Report `onDone` and `onError` of invoked behaviours whose event the inner states always handle first."""
    ends = [t for t in state.transitions if t.where[len(state.where) :][:1] == ("invoke",)]
    inner = list(_below(machine, state)) if ends else []
    leaves = [s for s in inner if s.kind in (StateKind.ATOMIC, StateKind.FINAL)]
    for end in ends if len(leaves) <= MAX_COMPARED_CANDIDATES else ():
        takers = [
            next((t for s in inner if is_within(leaf.path, s.path) for t in s.transitions if _takes(t, end)), None)
            for leaf in leaves
        ]
        first = takers[0] if takers else None
        if first is not None and None not in takers:
            message = f"this transition is never taken: the states inside `{state.name}` always handle the event first"
            hint = f"name the events there instead of `{first.event}`"
            related = [(first.where, "this is taken first")]
            report(SHADOWED_TRANSITION, end.where, message, hint, related=related)


def _below(machine: MachineDefinition, state: State) -> Iterator[State]:
    """Yield the descendants of a state, in document order."""
    for path in state.children:
        yield machine.states[path]
        yield from _below(machine, machine.states[path])


def _takes(transition: Transition, end: Transition) -> bool:
    """Return whether a transition is always taken when the event of `end` occurs."""
    return not (transition.guard or transition.hears or transition.approve) and covers(transition, end)


def _turn(transition: Transition) -> int:
    """Return the rank of a transition within its state: other events, then rows of `hears`, then `*`, then `else`."""
    if transition.hears:
        return 3 if transition.hears.way == "else" else 1
    return 2 if transition.event == "*" else 0


def covers(earlier: Transition, later: Transition) -> bool:
    """Return whether every event that selects `later` also selects `earlier`; guards do not count.

    A row of `hears` covers only other candidates of the same row, because phrases decide between rows. `*` and `done`
    also match the end of a `do`, of nested states and of an invoked behaviour; they do not match the end of a timer.
    """
    if earlier.timed != later.timed:
        return False
    if earlier.hears:
        return later.hears is not None and earlier.hears.key == later.hears.key
    if later.exact and earlier.event and not earlier.exact:
        return hears(earlier.event, later.event)
    if earlier.exact or later.exact or not (earlier.event and later.event):
        return earlier.event == later.event
    return hears(earlier.event, later.event.removesuffix(".*")) and (later.event != "*" or earlier.event == "*")


def _takes_all(earlier: Transition, later: Transition, machine: MachineDefinition, report: DocumentReport) -> bool:
    """Report a transition that an earlier one makes partly or wholly unreachable; return True if wholly."""
    related = [(earlier.where, "the earlier one is here")]
    if earlier.guard is None:
        if report.broken(earlier.where):  # the unreadable part may have been its guard
            return False
        line = report.document.place(earlier.where).line
        message = f"this transition is never taken: the one on line {line} is always taken first"
        hint = "give that transition a `guard`, or swap the two"
        if later.hears and not earlier.hears:
            hint = "give that transition a `guard`, or turn it into the row `else`"
        elif later.exact and not earlier.exact:
            key = later.where[len(machine.states[later.source].where)]
            hint = f"write `{key}` above `on`, or name the events instead of `{earlier.event}`"
        cause = f"{report.document.file} shadowed by {earlier.where}"
        report(SHADOWED_TRANSITION, later.where, message, hint, related=related, cause=cause)
        return True
    if later.guard is None:
        return False
    one, other = tree(earlier.guard.source), tree(later.guard.source)
    first, second = heard_call(one), heard_call(other)
    taken = _taken(first, second, machine) if first and second else frozenset()
    if _implies(later.guard.source, earlier.guard.source) and not _never(later.guard.source):
        message, hint = "this transition is never taken: an earlier one has the same guard", "delete one of the two"
        if one != other:
            wide = _short(earlier.guard.shown)
            message, hint = (
                f"this transition is never taken: `{wide}` is true whenever this guard is",
                "put this transition before that one",
            )
        report(SHADOWED_TRANSITION, later.where, message, hint, related=related)
        return True
    if taken and first and second and not _alike(earlier, later):
        said = sorted({p for texts in machine.phrases[second.name].values() for p in texts})
        whole = taken.issuperset(said)
        code = SHADOWED_TRANSITION if whole else OVERLAPPING_GUARDS
        shown = ", ".join(f"`{phrase}`" for phrase in sorted(taken)[:3])
        verb = "match" if len(taken) > 1 else "matches"
        message = f"{shown} of `{second.name}` {verb} `{first.name}`, which is tried first"
        report(code, later.where, message, "put the longer phrases first", related=related)
        return whole
    return False


def heard_call(node: ExpressionNode) -> HeardCall | None:
    """Return the call of `heard` that is the whole guard; None for any other guard."""
    match node:
        case FunctionCall(function="heard", arguments=(text, Literal(value=str() as name))):
            return HeardCall(text, name)
    return None


def _taken(first: HeardCall, second: HeardCall, machine: MachineDefinition) -> frozenset[str]:
    """Return the phrases of the second call that contain a phrase of the first."""
    if first.text != second.text or first.name not in machine.phrases or second.name not in machine.phrases:
        return frozenset()
    one, other = machine.phrases[first.name], machine.phrases[second.name]

    def heard() -> frozenset[str]:
        return frozenset(phrase for texts in other.values() for phrase in texts if is_taken(phrase, one))

    return memoize(("taken", machine.id, first.name, second.name), (one, other), heard)


def _alike(one: Transition, other: Transition) -> bool:
    """Return whether two transitions have the same effect."""
    return one.targets == other.targets and not (one.actions or other.actions)


def _short(source: str) -> str:
    return source if len(source) <= 60 else source[:59] + "…"
