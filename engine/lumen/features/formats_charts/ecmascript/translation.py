"""What the parts of a translation need of the whole, which has the names and goes down the tree."""

from typing import Protocol

from lumen.expressions.tree import ExpressionNode


class Translation(Protocol):
    """One expression of ECMAScript on its way into ours; `present` are the fields of the event known to be there."""

    present: frozenset[tuple[str, ...]]

    def value(self, tree: ExpressionNode) -> ExpressionNode:
        """Our tree with the same value; raises ScriptError."""

    def kind(self, node: ExpressionNode) -> str:
        """The kind of one of our trees, or UNKNOWN_KIND."""
