"""What `now()`, `weekday()` and `date()` are compared with: texts, of which no clock shows some."""

import re
from collections.abc import Iterator, Mapping

from lumen.interpreters.expressions.tree import Binary, ExpressionNode, FunctionCall, ListLiteral, Literal, walk
from lumen.language.actions import Expression
from lumen.language.diagnostics import WARNING, Code
from lumen.loading.draft import ProjectDraft
from lumen.rules.logic import tree
from lumen.rules.walk import expression_sites

ODD_TIME = Code("odd-time", "expressions", WARNING, "a time, day or date is compared with a text that no clock shows")

_SHOWN: Mapping[str, tuple[re.Pattern[str], str]] = {
    "now": (re.compile(r"([01][0-9]|2[0-3]):[0-5][0-9]"), "two digits each: `'09:30'`"),
    "weekday": (re.compile(r"mon|tue|wed|thu|fri|sat|sun"), "`'mon'` to `'sun'`"),
    "date": (re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}"), "year, month and day: `'2026-12-24'`"),
}
"""What each of them shows, and how that is said."""


def check(draft: ProjectDraft) -> None:
    """Report comparisons that never hold, or not when they were meant to."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for text in dict.fromkeys(site.text for site in expression_sites(machine)):
            if isinstance(text, Expression):
                for function, odd in _odd(tree(text.source)):
                    hint = f"it has {_SHOWN[function][1]}"
                    report(ODD_TIME, text.where, f"`{function}()` is never `{odd}`", hint=hint)


def _odd(condition: ExpressionNode) -> Iterator[tuple[str, str]]:
    """The functions that are compared with what they never give, and with what."""
    for node, _ in walk(condition):
        if isinstance(node, Binary) and node.sign in ("==", "!=", "<", "<=", ">", ">=", "in"):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if isinstance(one, FunctionCall) and one.function in _SHOWN:
                    for value in other.items if isinstance(other, ListLiteral) else (other,):
                        text = value.value if isinstance(value, Literal) else None
                        if isinstance(text, str) and not _SHOWN[one.function][0].fullmatch(text):
                            yield one.function, text
