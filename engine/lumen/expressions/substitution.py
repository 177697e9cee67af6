"""Expressions about the entries of lists, as expressions about the context: what `question` stands for is put in."""

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
"""The functions that take what stands in a list as it is, in all languages."""


def substituted(source: str, variables: Mapping[str, str], *, localized: bool = True) -> str:
    """The source with its `variables` replaced by what they stand for, which are paths such as `context.a.entry`.

    Where `localized`, a text of such a path, and of one into `lists`, is that of the current language. A source that
    speaks of neither, or can't be read, is given back as it is.
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
    """What the paths of a sound expression begin with."""
    return frozenset(node.name for node, _ in walk(parse_expression(source)) if isinstance(node, Identifier))


def substituted_template(text: str, variables: Mapping[str, str]) -> str:
    """The text with this done in each of its holes."""
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
        """The node with everything replaced; `whole` where its text is wanted in all languages."""
        match node:
            case Identifier() | FieldAccess() | IndexAccess():
                path = self.path(node)
                return FunctionCall("in_language", (path,)) if self._spoken(node) and not whole else path
            case FunctionCall(function=function, arguments=arguments):
                every = function in _WHOLE
                return replace(node, arguments=tuple(self.of(argument, whole=every) for argument in arguments))
        return rebuilt(node, self.of)

    def path(self, node: ExpressionNode) -> ExpressionNode:
        """A path with its beginning replaced."""
        match node:
            case Identifier(name=name):
                return self.meant.get(name, node)
            case FieldAccess(base=base):
                return replace(node, base=self.path(base))
            case IndexAccess(base=base, key=key):
                return replace(node, base=self.path(base), key=self.of(key))
        return self.of(node)

    def _spoken(self, node: ExpressionNode) -> bool:
        """Whether it is something in an entry, or in a list."""
        start = node
        while isinstance(start, FieldAccess | IndexAccess):
            start = start.base
        if not self.localized or not isinstance(start, Identifier):
            return False
        return start.name in self.meant or (start.name == "lists" and start is not node)
