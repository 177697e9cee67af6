"""Expressions about entries of lists, rewritten as expressions about the context: `question` becomes its path."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from lumen.errors import ExpressionError
from lumen.expressions.parser import MAX_REMEMBERED_TREES, parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.templates import split_template
from lumen.expressions.tree import (
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    rebuilt,
    walk,
)

_WHOLE = frozenset(("has", "heard"))
"""The functions for whose arguments texts by language are kept in all languages."""


def substituted(source: str, variables: Mapping[str, str], *, localized: bool = True) -> str:
    """Return the source with each of the `variables` replaced by its path, such as `context.a.entry`.

    If `localized`, texts at these paths, and at paths into `lists`, are reduced to the current language. A source that
    contains neither, or that is invalid, is returned unchanged.
    """
    try:
        tree = parse_expression(source)
    except ExpressionError:
        return source
    known = {"lists", *variables} if localized else {*variables}
    if known.isdisjoint(_roots(source)):
        return source
    return unparse(_Substitution(variables, localized).of(tree))


@lru_cache(maxsize=MAX_REMEMBERED_TREES)
def _roots(source: str) -> frozenset[str]:
    """Return the first names of all paths in a valid expression."""
    return frozenset(node.name for node, _ in walk(parse_expression(source)) if isinstance(node, Identifier))


def substituted_template(text: str, variables: Mapping[str, str]) -> str:
    """Return the template with `substituted` applied to each placeholder; unchanged if the template is invalid."""
    try:
        parts = split_template(text)
    except ExpressionError:
        return text
    done = [p if isinstance(p, str) else "{{ " + substituted(p.source, variables) + " }}" for p in parts]
    changed = any(not isinstance(p, str) and substituted(p.source, variables) != p.source for p in parts)
    return "".join(done) if changed else text


class _Substitution:
    def __init__(self, variables: Mapping[str, str], localized: bool) -> None:
        self.meant = {name: parse_expression(path) for name, path in variables.items()}
        self.localized = localized

    def of(self, node: ExpressionNode, *, whole: bool = False) -> ExpressionNode:
        """Return the node with all variables replaced; with `whole`, its texts stay in all languages."""
        match node:
            case Identifier() | FieldAccess() | IndexAccess():
                path = self.path(node)
                return FunctionCall("in_language", (path,)) if self._spoken(node) and not whole else path
            case FunctionCall(function=function, arguments=arguments):
                every = function in _WHOLE
                return replace(node, arguments=tuple(self.of(argument, whole=every) for argument in arguments))
        return rebuilt(node, self.of)

    def path(self, node: ExpressionNode) -> ExpressionNode:
        """Return a path with its first name replaced, if that name is a variable."""
        match node:
            case Identifier(name=name):
                return self.meant.get(name, node)
            case FieldAccess(base=base):
                return replace(node, base=self.path(base))
            case IndexAccess(base=base, key=key):
                return replace(node, base=self.path(base), key=self.of(key))
        return self.of(node)

    def _spoken(self, node: ExpressionNode) -> bool:
        """Return whether the path leads into an entry or a list, so that its text must be localized."""
        start = node
        while isinstance(start, FieldAccess | IndexAccess):
            start = start.base
        if not self.localized or not isinstance(start, Identifier):
            return False
        return start.name in self.meant or (start.name == "lists" and start is not node)
