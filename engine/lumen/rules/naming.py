"""What the expressions of a behaviour name: keys of the context, lists, and texts, by which phrases are asked for."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.interpreters.expressions import split_template
from lumen.interpreters.expressions.templates import Placeholder
from lumen.interpreters.expressions.tree import (
    ExpressionNode,
    FieldAccess,
    Identifier,
    IndexAccess,
    Literal,
    children,
    walk,
)
from lumen.language.actions import Expression, Template
from lumen.language.machines import MachineDefinition
from lumen.rules.logic import tree
from lumen.rules.walk import expression_sites


class Named(NamedTuple):
    """`keys` of the context and `lists`, None where an expression may read any of them; all `texts` in quotes."""

    keys: frozenset[str] | None
    lists: frozenset[str] | None
    texts: frozenset[str]


def named_in(machine: MachineDefinition) -> Named:
    """What a behaviour names whose expressions are known to be sound."""
    keys, lists, texts = set[str | None](), set[str | None](), set[str]()
    for root in _trees(machine):
        keys |= {*_read(root, "context")}
        lists |= {*_read(root, "lists")}
        texts |= {node.value for node, _ in walk(root) if isinstance(node, Literal) and isinstance(node.value, str)}
    return Named(_all(keys), _all(lists), frozenset(texts))


def _trees(machine: MachineDefinition) -> Iterator[ExpressionNode]:
    """Every expression, those in texts and in answers too."""
    sites = dict.fromkeys(site.text for site in expression_sites(machine))
    values = (row.value for rows in machine.answers.values() for row in rows)
    for text in (*sites, *(Template(t) for value in values for t in _texts(value))):
        yield from trees(text)


def trees(text: Expression | Template) -> Iterator[ExpressionNode]:
    """The expression, or each of those in a text; of sound ones."""
    if isinstance(text, Expression):
        yield tree(text.source)
    elif "{{" in text.text:
        yield from (tree(part.source) for part in split_template(text.text) if isinstance(part, Placeholder))


def _read(root: ExpressionNode, base: str) -> Iterator[str | None]:
    """The names behind `base`, None where it stands alone or what follows is computed."""
    waiting = [root]
    while waiting:
        node = waiting.pop()
        match node:
            case FieldAccess(base=Identifier(name=name), name=key) if name == base:
                yield key
            case IndexAccess(base=Identifier(name=name), key=Literal(value=str() as key)) if name == base:
                yield key
            case Identifier(name=name) if name == base:
                yield None
            case _:
                waiting += children(node)


def _all(names: set[str | None]) -> frozenset[str] | None:
    return None if None in names else frozenset(name for name in names if name is not None)


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _texts(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _texts(item)
