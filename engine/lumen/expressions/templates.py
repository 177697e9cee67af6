"""Texts that contain `{{ expression }}`."""

import json
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions.checker import check_expression
from lumen.expressions.compiler import compile_expression
from lumen.expressions.expression_findings import EXPRESSION_SYNTAX, ExpressionFinding
from lumen.expressions.kinds import FaultError
from lumen.expressions.operators import bounded
from lumen.expressions.own_functions import KnownFunctions, expanded
from lumen.expressions.scope import MAX_TEXT_LENGTH, Scope
from lumen.expressions.tokens import token_at


class Placeholder(NamedTuple):
    """An expression in a text, and the offset in the text where its source begins."""

    source: str
    offset: int


@lru_cache(maxsize=8192)
def compile_template(text: str) -> Callable[[Scope], str]:
    """Return the text as a function of a Scope that fills in its placeholders; errors have offsets in the text.

    null becomes an empty text, true and false stay words, integral numbers have no fraction (1.0 is "1"), and lists and
    maps become JSON. The function raises ExpressionError if a placeholder has no value, or the text becomes too long.
    """
    parts = split_template(text)
    if all(isinstance(part, str) for part in parts):
        return lambda scope: text
    fillers = [_constant(part) if isinstance(part, str) else _filler(part) for part in parts]

    def fill(scope: Scope) -> str:
        filled = "".join([filler(scope) for filler in fillers])
        if len(filled) > MAX_TEXT_LENGTH:
            raise ExpressionError("the text becomes too long", 0, f"at most {MAX_TEXT_LENGTH:,} characters are allowed")
        return filled

    return fill


def _constant(text: str) -> Callable[[Scope], str]:
    return lambda scope: text


def _filler(hole: Placeholder) -> Callable[[Scope], str]:
    try:
        evaluate = compile_expression(hole.source)
    except ExpressionError as error:
        raise moved(error, hole.offset) from None

    def fill(scope: Scope) -> str:
        try:
            return printed(evaluate(scope))
        except ExpressionError as error:
            raise moved(error, hole.offset) from None

    return fill


def moved(error: ExpressionError, offset: int) -> ExpressionError:
    """Return the error with its offset moved, for an expression that begins at `offset` of a text."""
    return ExpressionError(error.message, error.offset + offset, error.hint)


def split_template(text: str) -> list[str | Placeholder]:
    """Return the plain texts and the placeholders, in order; raise ExpressionError if a placeholder is not closed."""
    parts: list[str | Placeholder] = []
    position = 0
    while (start := text.find("{{", position)) >= 0:
        end = _closing(text, start + 2)
        parts += [text[position:start], Placeholder(text[start + 2 : end], start + 2)]
        position = end + 2
    parts.append(text[position:])
    return [part for part in parts if part]


def _closing(text: str, offset: int) -> int:
    """Return the offset of the `}}` that ends the placeholder, outside of maps and texts.

    Raises ExpressionError if it is missing.
    """
    start, level = offset - 2, 0
    while offset < len(text):
        if level == 0 and text.startswith("}}", offset):
            return offset
        token = token_at(text, offset)
        level += {"{": 1, "}": -1}.get(token.text, 0)
        offset = token.end
    raise ExpressionError("this `{{` is not closed", start, "write `}}` after the expression")


def printed(value: Any) -> str:
    """Return a value as text; raise ExpressionError for a list or map that is too large."""
    if isinstance(value, str):
        return value
    try:
        return "" if value is None else json.dumps(_plain(bounded(value)), ensure_ascii=False)
    except (FaultError, TypeError, ValueError) as fault:
        raise ExpressionError(str(fault)) from None


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return int(value)
    return value


def expanded_template(text: str, functions: KnownFunctions) -> str:
    """Return the text with `expanded` applied to each `{{ expression }}`; raise the same errors."""
    if not any(name in text for name in functions):
        return text
    parts = []
    for part in split_template(text):
        if isinstance(part, str):
            parts.append(part)
            continue
        try:
            meant = expanded(part.source, functions)
        except ExpressionError as error:
            raise moved(error, part.offset) from None
        parts.append("{{" + (part.source if meant == part.source else f" {meant} ") + "}}")
    return "".join(parts)


def check_template(text: str, *, context: Mapping[str, Any] | None, **around: Any) -> list[ExpressionFinding]:
    """Return the findings of `check_expression` (same arguments) in the placeholders, with offsets in the text."""
    try:
        holes = [part for part in split_template(text) if isinstance(part, Placeholder)]
    except ExpressionError as error:
        return [ExpressionFinding(EXPRESSION_SYNTAX, error.offset, 1, error.message, error.hint)]
    found = [(hole, _meant(hole, check_expression(hole.source, context=context, **around))) for hole in holes]
    return [finding._replace(offset=finding.offset + hole.offset) for hole, findings in found for finding in findings]


def _meant(hole: Placeholder, findings: list[ExpressionFinding]) -> list[ExpressionFinding]:
    """Return the findings in a placeholder; for three braces, as in Handlebars, one finding about the third brace."""
    inner = hole.source.removeprefix("{").removesuffix("}").strip()
    if not hole.source.startswith("{") or not any(f.code == EXPRESSION_SYNTAX for f in findings):
        return findings
    message, hint = "the third brace would begin a map", f"write two braces on each side: `{{{{ {inner} }}}}`"
    return [ExpressionFinding(EXPRESSION_SYNTAX, 0, 1, message, hint)]
