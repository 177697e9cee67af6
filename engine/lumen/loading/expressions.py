"""Expressions and templates in a file: their syntax checked, each fault at its character."""

from collections.abc import Callable, Iterable
from typing import Any

from lumen.interpreters.expressions import ExpressionError, compile_expression, compile_template
from lumen.language.actions import Expression, Template, Value
from lumen.language.diagnostics import Diagnostic, Path, Place, did_you_mean
from lumen.loading.source import Document, Report


class Expressions:
    """Reads the expressions of one document, whose context has these `keys`."""

    def __init__(self, report: Report, keys: Iterable[str]) -> None:
        self.report = report
        self.keys = frozenset(keys)

    def expression(self, source: str, where: Path) -> Expression | None:
        """The expression, None (and reported) where it can't be read."""
        return Expression(source, where) if self._reads(compile_expression, source, where) else None

    def template(self, text: str, where: Path) -> Template | None:
        """The text with its `{{ expressions }}`, None (and reported) where one can't be read."""
        return Template(text, where) if self._reads(compile_template, text, where) else None

    def value(self, data: Any, where: Path) -> Value:
        """Every text an expression, lists and maps read through; None in place of what can't be read."""
        match data:
            case str():
                return self.expression(data, where)
            case list() | tuple():
                return tuple(self.value(item, (*where, i)) for i, item in enumerate(data))
            case dict():
                return {key: self.value(item, (*where, key)) for key, item in data.items()}
            case None | bool() | int() | float():
                return data
        return None

    def key(self, key: str, where: Path) -> bool:
        """Whether the context declares this key; reported where not."""
        if key in self.keys:
            return True
        hint = did_you_mean(key, self.keys, "context: declares")
        self.report("unknown-context-key", where, f"the context has no `{key}`", hint=hint, key=True)
        return False

    def _reads(self, compiler: Callable[[str], object], source: str, where: Path) -> bool:
        try:
            compiler(source)
        except ExpressionError as error:
            place = place_within(self.report.document, where, source, error.offset)
            self.report.diagnostics.append(Diagnostic("expression-syntax", error.message, place, error.hint))
            return False
        return True


def place_within(document: Document, path: Path, source: str, offset: int | None) -> Place:
    """The place of one character of the text at `path`; of the whole text where that has several lines or escapes."""
    place = document.place(path)
    lines = document.text.splitlines()
    if offset is None or place.line != place.end_line or place.line > len(lines):
        return place
    line = lines[place.line - 1]
    start = place.column - 1
    start += line[start : start + 1] in ("'", '"')
    if not line.startswith(source, start):
        return place
    column = start + min(offset, max(len(source) - 1, 0)) + 1
    return place._replace(column=column, end_column=column + 1)
