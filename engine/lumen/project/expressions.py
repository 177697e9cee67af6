"""Check the syntax of expressions and templates in a file; each fault is reported at its character."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from lumen.expressions import (
    ExpressionError,
    ExpressionFinding,
    check_expression,
    check_template,
    substituted,
    substituted_template,
)
from lumen.expressions.expression_findings import (
    MISPLACED_DRAW,
    UNGUARDED_FIELD,
    UNKNOWN_CONTEXT_KEY,
    UNKNOWN_FUNCTION,
    UNKNOWN_NAME,
)
from lumen.expressions.function_table import drawing_functions
from lumen.expressions.functions import CAUGHT
from lumen.expressions.own_functions import BrokenFunctionError, KnownFunctions, expanded
from lumen.expressions.templates import expanded_template
from lumen.language.actions import ComputedValue, Expression, Template
from lumen.language.diagnostics import ERROR, Code, NodePath, Place, did_you_mean
from lumen.language.text_lines import lines_of
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.known_words import KnownWords
from lumen.project.numbers import finite
from lumen.project.remembered_findings import Check, RememberedFindings
from lumen.project.rounds import Rounds
from lumen.project.scalars import within
from lumen.talk.hearing import HEARD

FUNCTION_SIZE = Code("function-size", "expressions", ERROR, "an expression is too large with its functions put in")

Expand = Callable[[str, KnownFunctions], str]
"""The type of `expanded` and `expanded_template`."""


class Expressions:
    """Reads the expressions of one document, `data`, whose states have these names.

    It checks what needs no types: syntax, functions, and the names that the file itself declares.
    """

    def __init__(
        self, report: DocumentReport, data: Mapping[str, Any], words: KnownWords, states: Iterable[str], rounds: Rounds
    ) -> None:
        self.report, self.rounds, self.words = report, rounds, words
        self.keys = frozenset((*(data.get("context") or ()), *rounds.known))
        self.functions = words.functions
        self.used: set[str] = set()
        """The project's functions whose names occur in the expressions: all that are called, and perhaps others."""
        names: dict[str, Any] = {
            "functions": self.functions,
            "context": {key: {} for key in self.keys},
            **{key: tuple(table) if words.whole else None for key, table in words.tables.items()},
            "lists": {key: {} for key in words.tables["lists"]} if words.whole else None,
            "states": tuple(states),
        }
        self.findings = RememberedFindings(("expressions", report.document.file), names)

    def expression(self, source: str, where: NodePath) -> Expression | None:
        """Return the compiled expression; if `source` can't be read, report why and return None."""
        return self._read(source, where, localized=True)

    def whole(self, source: str, where: NodePath) -> Expression | None:
        """Return the expression as `expression` does, but with lists in all languages instead of the current one."""
        return self._read(source, where, localized=False)

    def _read(self, source: str, where: NodePath, *, localized: bool) -> Expression | None:
        variables = self.rounds.variables(where)
        if not self._sound(check_expression, source, where, variables):
            return None
        meant = self._expanded(expanded, substituted(source, variables, localized=localized), source, where)
        return None if meant is None else Expression(meant, where, source if meant != source else "")

    def template(self, text: str, where: NodePath) -> Template | None:
        """Return the text with its `{{ expressions }}`; if one can't be read, report why and return None."""
        variables = self.rounds.variables(where)
        if not self._sound(check_template, text, where, variables):
            return None
        meant = self._expanded(expanded_template, substituted_template(text, variables), text, where)
        return None if meant is None else Template(meant, where, text if meant != text else "")

    def value(self, data: Any, where: NodePath) -> ComputedValue:
        """Return data with each text read as an expression, even in lists and maps; unreadable texts become None.

        A number that is not finite is reported and becomes None: values go into messages and snapshots, and JSON has no
        infinity or NaN.
        """
        match data:
            case str():
                return self.expression(data, where)
            case list() | tuple():
                return tuple(self.value(item, (*where, i)) for i, item in enumerate(data))
            case dict():
                return {key: self.value(item, (*where, key)) for key, item in data.items()}
            case None | bool():
                return data
            case int() | float():
                return data if finite(data, self.report, where) else None
        return None

    def key(self, key: str, where: NodePath) -> bool:
        """Return True if the context declares this key; otherwise, report the key."""
        if key in self.keys:
            return True
        hint = did_you_mean(key, self.keys, "`context` has")
        message = f"the context has no `{key}`"
        cause = f"{self.report.document.file} context {key}"
        self.report(UNKNOWN_CONTEXT_KEY, where, message, hint=hint, key=True, cause=cause)
        return False

    def _sound(self, check: Check, source: str, where: NodePath, variables: Iterable[str]) -> bool:
        """Return True if no fault was found, and report faults. Absent fields are ignored: they depend on callers."""
        names = tuple(variables)
        findings = self.findings.of(check, source, names, lambda: {"variables": {name: {} for name in names}})
        found = [finding for finding in findings if finding.code != UNGUARDED_FIELD]
        for finding in map(self._explained, found):
            place = place_within(self.report.document, where, source, finding.offset, finding.length)
            cause = cause_of(self.report.document.file, finding)
            self.report.diagnostics.append(finding.code.at(place, finding.message, finding.hint, cause=cause))
        return not found and self._calls_what_it_may(source, where) and self._draws_where_it_may(source, where)

    def _expanded(self, expand: Expand, meant: str, written: str, where: NodePath) -> str | None:
        """Return the source or text with the project's functions expanded; None if that can't be done."""
        if not self.functions:
            return meant
        self.used |= {name for name in self.functions if name in meant}
        return expanded_here(expand, meant, self.functions, self.report, where, written)

    def _explained(self, finding: ExpressionFinding) -> ExpressionFinding:
        """Return the finding; for a name that is defined elsewhere in the file, with the place in its hint."""
        name = finding.message.split("`")[1] if finding.code == UNKNOWN_NAME else ""
        if name == HEARD:
            return finding._replace(
                hint="it is defined only in the guard and actions of a row of `hears`: assign it to the context there"
            )
        home = self.rounds.elsewhere(name) if name else ""
        hint = f"it is defined only inside `{home}`: in its states, `on` and `after`"
        return finding._replace(hint=hint) if home else finding

    def _calls_what_it_may(self, source: str, where: NodePath) -> bool:
        """Return True if `caught`, which is reserved for the engine, is not called; otherwise, report the call."""
        if CAUGHT not in source or not re.search(rf"\b{CAUGHT}\s*\(", source):
            return True
        self.report(
            UNKNOWN_FUNCTION, where, f"there is no function `{CAUGHT}`", "write `heard.NAME` in a row of `hears`"
        )
        return False

    def _draws_where_it_may(self, source: str, where: NodePath) -> bool:
        """Return True if no random value is drawn outside `assign`; otherwise, report the call."""
        if "assign" in where or not any(name in source for name in drawing_functions()):
            return True
        drawing = next((name for name in sorted(drawing_functions()) if re.search(rf"\b{name}\s*\(", source)), "")
        if drawing:
            hint = "assign the value to a key of `context`, and use that key here"
            self.report(
                MISPLACED_DRAW, where, f"`{drawing}` gives a random value, which is allowed only in `assign`", hint
            )
        return not drawing


def expanded_here(
    expand: Expand, source: str, functions: KnownFunctions, report: DocumentReport, where: NodePath, written: str = ""
) -> str | None:
    """Return the valid expression or text at a path with calls of the project's functions expanded.

    Return None if one of them is broken, which only marks the node as pruned, or if the result is too large, which is
    reported. `written` is the source as the author wrote it, if that differs.
    """
    try:
        return expand(source, functions)
    except BrokenFunctionError:
        report.pruned.add(where)
    except ExpressionError as error:
        shown = written or source
        offset = error.offset if shown == source else 0
        word = re.match(r"\w*", shown[offset:])
        place = place_within(report.document, where, shown, offset, len(word[0]) if word else 1)
        report.diagnostics.append(FUNCTION_SIZE.at(place, error.message, error.hint))
    return None


def cause_of(file: str, finding: ExpressionFinding) -> str:
    """Return the cause that all findings about one unknown or unguarded name in a file share; empty for others."""
    if finding.code == UNKNOWN_CONTEXT_KEY:
        return f"{file} context {finding.message.split('`')[1]}"
    return f"{file} {finding.message}" if finding.code.startswith("unknown-") or finding.code == UNGUARDED_FIELD else ""


def place_within(document: Document, path: NodePath, source: str, offset: int, length: int) -> Place:
    """Return the place of some characters of the text at `path`; that of the whole text if they can't be located.

    A template that computes the delay of an `after` is a key, so it is the last step of its path.
    """
    place = document.place(path, key=path[-2:] == ("after", source))
    line = lines_of(document.text)[place.line - 1]
    start = place.column - 1
    start += line[start : start + 1] in ("'", '"')
    if place.line != place.end_line or not line.startswith(source, start):
        return within(document.text, place, source, offset, length) or place
    column = start + min(offset, max(len(source) - 1, 0)) + 1
    return place._replace(column=column, end_column=column + length)
