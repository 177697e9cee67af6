"""Comparisons of `now()`, `weekday()`, `date()`, `hour()` and `minute()` with values that no clock shows."""

import re
from collections.abc import Iterator, Mapping

from lumen.expressions.tree import Binary, ExpressionNode, FunctionCall, ListLiteral, Literal, walk
from lumen.language.diagnostics import WARNING, Code
from lumen.lint.naming import trees
from lumen.lint.walk import expression_sites
from lumen.project.draft import ProjectDraft

ODD_TIME = Code("odd-time", "expressions", WARNING, "a time, day or date is compared with an impossible value")

_SHOWN: Mapping[str, tuple[re.Pattern[str], str]] = {
    "now": (re.compile(r"([01][0-9]|2[0-3]):[0-5][0-9]"), "write two digits each, such as `'09:30'`"),
    "weekday": (re.compile(r"mon|tue|wed|thu|fri|sat|sun"), "write a day from `'mon'` to `'sun'`"),
    "date": (re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}"), "write year, month and day, such as `'2026-12-24'`"),
}
"""The form of each function's result, and the hint for a text of another form."""


_COUNTED: Mapping[str, int] = {"hour": 23, "minute": 59}
"""The maximum result of each function; the minimum is 0."""

_ASKED = re.compile("|".join((*_SHOWN, *_COUNTED)))


def check(draft: ProjectDraft) -> None:
    """Report comparisons of a clock function with an impossible value."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        broken = {d.place.line for d in report.diagnostics}
        for text in dict.fromkeys(site.text for site in expression_sites(machine)):
            if not _ASKED.search(text.shown) or report.document.place(text.where).line in broken:
                continue
            for root in trees(text):
                for function, odd in _odd(root):
                    report(ODD_TIME, text.where, f"`{function}()` is never `{odd}`", hint=_SHOWN[function][1])
                for function, number in _beyond(root):
                    hint = f"write a number from 0 to {_COUNTED[function]}"
                    report(ODD_TIME, text.where, f"`{function}()` is never {number:g}", hint=hint)


def _beyond(condition: ExpressionNode) -> Iterator[tuple[str, float]]:
    """Yield each function that is compared with a number outside its range, and that number."""
    for node, _ in walk(condition):
        if isinstance(node, Binary) and node.sign in ("==", "!=", "<", "<=", ">", ">="):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if isinstance(one, FunctionCall) and one.function in _COUNTED and isinstance(other, Literal):
                    number = other.value
                    if isinstance(number, int | float) and not 0 <= number <= _COUNTED[one.function]:
                        yield one.function, number


def _odd(condition: ExpressionNode) -> Iterator[tuple[str, str]]:
    """Yield each function that is compared with a text that it never returns, and that text."""
    for node, _ in walk(condition):
        if isinstance(node, Binary) and node.sign in ("==", "!=", "<", "<=", ">", ">=", "in"):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if isinstance(one, FunctionCall) and one.function in _SHOWN:
                    for value in other.items if isinstance(other, ListLiteral) else (other,):
                        text = value.value if isinstance(value, Literal) else None
                        if isinstance(text, str) and not _SHOWN[one.function][0].fullmatch(text):
                            yield one.function, text
