"""Terms of controllers, checked against their names, their variable's range, and each other."""

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite

from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.survey import grid
from lumen.language.controllers import VALUE_TERMS, ControllerDefinition, Term, Variable
from lumen.language.diagnostics import WARNING, Code
from lumen.language.scales import ranks
from lumen.project.document_report import DocumentReport

COVERAGE_GAP = Code("coverage-gap", "controllers", WARNING, "no term is true in a part of an input's range")
TERM_ORDER = Code("term-order", "controllers", WARNING, "the order of the terms contradicts their names")
UNREACHABLE_TERM = Code("unreachable-term", "controllers", WARNING, "a term lies outside its variable's range")


MIN_MEMBERSHIP = 0.01
"""A membership below this counts as 0."""

GRID_POINTS = 129

SampledTerm = tuple[Term, list[float]]


def check(controller: ControllerDefinition, report: DocumentReport) -> None:
    """Report terms in the wrong order for their names, terms outside the range, and gaps between terms."""
    for variable in (*controller.inputs.values(), *controller.outputs.values()):
        weighted = variable.name in controller.outputs and variable.weighted
        if not (isfinite(variable.minimum) and isfinite(variable.maximum)):
            continue
        xs = list(grid(variable, GRID_POINTS))
        rows = [] if weighted else [(term, _memberships(term, xs)) for term in variable.terms.values()]
        _order(variable, rows, xs, report)
        sets = [row for row in rows if _reached(variable, row, report)]
        if variable.name in controller.inputs and len(sets) == len(rows) > 1:
            _gaps(variable, sets, xs, report)


def _memberships(term: Term, xs: list[float]) -> list[float]:
    shape = membership(NUMBERS, term)
    return [float(shape(x)) for x in xs]


def _order(variable: Variable, rows: list[SampledTerm], xs: list[float], report: DocumentReport) -> None:
    """Report terms whose order contradicts the meaning of their names (`small`, `large`)."""
    places = {term.name: _top(degrees, xs) for term, degrees in rows}
    places |= {term.name: term.parameters[0] for term in variable.terms.values() if term.kind == VALUE_TERMS[0]}
    scale = ranks(tuple(places))
    ordered = sorted(scale, key=lambda name: scale[name])
    for before, after in pairwise(ordered):
        if scale[before] < scale[after] and places[before] > places[after]:
            term, other = variable.terms[after], variable.terms[before]
            message = (
                f"`{after}` of `{variable.name}` is at {places[after]:g}, but `{before}` is above it,"
                f" at {places[before]:g}"
            )
            hint = f"swap the numbers of `{before}` and `{after}`, or their names"
            report(TERM_ORDER, term.where, message, hint, key=True, related=[(other.where, "the other one")])


def _top(degrees: list[float], xs: list[float]) -> float:
    """Return the middle of the points `xs` at which a term has its maximum membership."""
    most = max(degrees)
    tops = [x for x, degree in zip(xs, degrees, strict=True) if degree >= most - 1e-9]
    return sum(tops) / len(tops)


def _reached(variable: Variable, row: SampledTerm, report: DocumentReport) -> bool:
    term, degrees = row
    inside = [x for x in term.parameters if variable.minimum <= x <= variable.maximum]
    if max(degrees) > 0.0 or max(_memberships(term, inside), default=0.0) > 0.0:
        return True
    low, high = variable.minimum, variable.maximum
    message = f"`{term.name}` is never true between {low:g} and {high:g}, the range of `{variable.name}`"
    report(UNREACHABLE_TERM, term.where, message, "move it into the range, or widen the range", key=True)
    return False


def _gaps(variable: Variable, rows: list[SampledTerm], xs: list[float], report: DocumentReport) -> None:
    """Report parts of an input's range in which no term is true."""
    whole = [max(degrees) for degrees in zip(*(degrees for _, degrees in rows), strict=True)]
    for first, last in _runs([degree < MIN_MEMBERSHIP for degree in whole]):
        low, high = xs[max(first - 1, 0)], xs[min(last + 1, len(xs) - 1)]
        if first == last and (first in (0, len(xs) - 1) or _narrow(rows)):
            continue
        message = f"no term of `{variable.name}` is true between {low:g} and {high:g}, so no rule fires"
        hint = "widen the terms beside the gap, or narrow the range"
        report(COVERAGE_GAP, (*variable.where, "range"), message, hint)


def _narrow(rows: list[SampledTerm]) -> bool:
    """Return whether a term is so narrow that it can be between two points of the grid."""
    return any(sum(degree > MIN_MEMBERSHIP for degree in degrees) < 2 for _, degrees in rows)


def _runs(flags: list[bool]) -> Iterator[tuple[int, int]]:
    """Yield the first and last index of each run of True."""
    start = None
    for i, flag in enumerate([*flags, False]):
        if flag and start is None:
            start = i
        elif not flag and start is not None:
            yield start, i - 1
            start = None
