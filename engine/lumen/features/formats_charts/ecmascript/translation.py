"""The interface that the parts of a translation need: the translation of subexpressions and names."""

from typing import Protocol

from lumen.expressions.tree import ExpressionNode


class Translation(Protocol):
    """The translation of one ECMAScript expression; `present` are the fields of the event known to be present."""

    present: frozenset[tuple[str, ...]]

    def value(self, tree: ExpressionNode) -> ExpressionNode:
        """Return Lumen's tree with the same value. Raises ScriptError if it has no counterpart."""

    def kind(self, node: ExpressionNode) -> str:
        """Return the kind of one of Lumen's trees, or UNKNOWN_KIND."""
