"""The interface through which helper modules translate subexpressions."""

from typing import Protocol

from lumen.expressions.tree import ExpressionNode


class Translation(Protocol):
    """Translates one ECMAScript expression."""

    present: frozenset[tuple[str, ...]]
    """The paths of the event fields known to be present."""

    def value(self, tree: ExpressionNode) -> ExpressionNode:
        """Return a Lumen tree with an ECMAScript tree's value. Raises ScriptError if there is none."""

    def kind(self, node: ExpressionNode) -> str:
        """Return the kind of a Lumen tree's value, or UNKNOWN_KIND."""
