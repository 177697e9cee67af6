"""Names that a behaviour uses: keys of the context, lists, and texts that can name phrases."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.expressions import split_template
from lumen.expressions.templates import Placeholder
from lumen.expressions.tree import (
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    Literal,
    children,
    walk,
)
from lumen.language.actions import Expression, Template
from lumen.language.machines import Hears, MachineDefinition
from lumen.lint.logic import tree
from lumen.lint.walk import expression_sites
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import Same, memoize
from lumen.talk.patterns import slots_of


class Named(NamedTuple):
    """The names that a behaviour uses."""

    keys: frozenset[str] | None
    """Keys of the context; None if an expression can read any key."""
    lists: frozenset[str] | None
    """Lists; None if an expression can read any list."""
    texts: frozenset[str]
    """All texts in quotes, the names in rows of `hears`, and the types of slots, which can be lists."""


def named_in(machine: MachineDefinition) -> Named:
    """Return the names that a behaviour uses; its expressions must be valid."""
    return memoize(("names", machine.id), Same(machine), lambda: _named_in(machine))


def _named_in(machine: MachineDefinition) -> Named:
    keys, lists, texts = set[str | None](), set[str | None](), set[str]()
    for root in _trees(machine):
        keys |= {*read_names(root, "context")}
        lists |= {*read_names(root, "lists")}
        texts |= {node.value for node, _ in walk(root) if isinstance(node, Literal) and isinstance(node.value, str)}
    texts |= {name for row in heard_rows(machine) for name in row.names}
    texts |= {slot.type for phrase in _phrases(machine) if "{" in phrase for slot in slots_of(phrase)}
    return Named(_all(keys), _all(lists), frozenset(texts))


def looked_up(draft: ProjectDraft) -> set[str]:
    """Return the tables of answers that are arguments of `lookup` in expressions; their first matching row wins."""
    calls = (
        node.arguments[-1]
        for machine in draft.behaviors.values()
        for site in expression_sites(machine)
        if "lookup" in site.text.shown
        for root in trees(site.text)
        for node, _ in walk(root)
        if isinstance(node, FunctionCall) and node.function == "lookup" and node.arguments
    )
    return {name.value for name in calls if isinstance(name, Literal) and isinstance(name.value, str)}


def heard_rows(machine: MachineDefinition) -> Iterator[Hears]:
    """Yield the rows of `hears` of all states."""
    yield from (t.hears for state in machine.states.values() for t in state.transitions if t.hears)


def _phrases(machine: MachineDefinition) -> Iterator[str]:
    tables = (*machine.phrases.values(), *(row.phrases for rows in machine.answers.values() for row in rows))
    yield from (phrase for table in tables for texts in table.values() for phrase in texts)


def _trees(machine: MachineDefinition) -> Iterator[ExpressionNode]:
    """Yield every expression, including those in texts and in answers."""
    sites = dict.fromkeys(site.text for site in expression_sites(machine))
    values = (row.value for rows in machine.answers.values() for row in rows)
    for text in (*sites, *(Template(t) for value in values for t in _texts(value))):
        yield from trees(text)


def trees(text: Expression | Template) -> Iterator[ExpressionNode]:
    """Yield the tree of an expression, or of each expression in a text; all of them must be valid."""
    if isinstance(text, Expression):
        yield tree(text.source)
    elif "{{" in text.text:
        yield from (tree(part.source) for part in split_template(text.text) if isinstance(part, Placeholder))


def read_names(root: ExpressionNode, base: str) -> Iterator[str | None]:
    """Yield the names read from `base`, as in `context.NAME`; None if `base` is used alone or the name is computed."""
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
