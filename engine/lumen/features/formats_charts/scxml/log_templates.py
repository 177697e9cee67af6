"""Converts `<log>` to Lumen's templates with `{{ … }}`, and back."""

import re

from lumen.expressions import split_template, unparse
from lumen.expressions.kinds import TEXT
from lumen.expressions.templates import Placeholder
from lumen.expressions.tree import Binary, ExpressionNode, Literal
from lumen.features.formats_charts.ecmascript import (
    ScriptError,
    ScriptNames,
    Vocabulary,
    parse_script,
    write_expression,
)
from lumen.features.formats_charts.ecmascript.kind_inference import kind
from lumen.features.formats_charts.ecmascript.reader import ScriptTranslator, printed
from lumen.project.formats.xml_elements import XmlElement


def template_of(element: XmlElement, names: ScriptNames) -> str:
    """Return a `<log>` as a template: its label, then its expression, split at each `+` that joins text.

    Raises ScriptError if the expression has no counterpart.
    """
    source = element.get("expr")
    parts = _parts(parse_script(source), names) if source else ()
    return plain_template(element, "") + "".join(_piece(part) for part in parts)


def plain_template(element: XmlElement, text: str) -> str:
    """Return a `<log>`'s label and a text as a template without computed values."""
    label = element.get("label")
    between = ": " if label and element.get("expr") else ""
    return _piece(Literal(label + between + text))


def _parts(tree: ExpressionNode, names: ScriptNames) -> list[ExpressionNode]:
    """Translate the operands of a `+` chain that joins text, or any other expression as the only part."""
    chain: list[ExpressionNode] = []
    rest = tree
    while isinstance(rest, Binary) and rest.sign == "+":
        chain.insert(0, rest.right)
        rest = rest.left
    translator = ScriptTranslator(names)
    read = [translator.value(part) for part in (rest, *chain)]
    kinds = [kind(part, names.kinds) for part in read[:2]]
    return read if TEXT in kinds else [translator.value(tree)]


def _piece(node: ExpressionNode) -> str:
    if isinstance(node, Literal) and isinstance(node.value, str):
        return re.sub(r"\{(?=\{)|\{$", "{{ '{' }}", node.value)
    return f"{{{{ {printed(node)} }}}}"


def expression_of(text: str, vocabulary: Vocabulary) -> tuple[str, tuple[str, ...]]:
    """Translate a template to an ECMAScript expression; also return the names in it that only Lumen has.

    Raises ScriptError if ECMAScript can't express a value.
    """
    parts = split_template(text)
    if not any(isinstance(part, Placeholder) for part in parts):
        return unparse(Literal(text)), ()
    pieces, foreign = [], list[str]()
    for part in parts:
        if isinstance(part, Placeholder):
            written = write_expression(part.source, vocabulary)
            foreign += written.foreign
            pieces.append(written.text if len(parts) == 1 else f"({written.text})")
        else:
            pieces.append(unparse(Literal(part)))
    start = ["''"] if isinstance(parts[0], Placeholder) and len(parts) > 1 else []
    return " + ".join([*start, *pieces]), tuple(foreign)


__all__ = ["ScriptError", "expression_of", "template_of"]
