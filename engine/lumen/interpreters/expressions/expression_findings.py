"""What is wrong with an expression, and the declarations by which that is decided."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from lumen.interpreters.expressions.kinds import KIND_DESCRIPTIONS
from lumen.interpreters.expressions.tree import ExpressionNode


class ExpressionFinding(NamedTuple):
    """A fault of an expression: `offset` and `length` [characters] are its place in the source."""

    code: str
    offset: int
    length: int
    message: str
    hint: str = ""


CODES_OF_COMPILE_ERRORS = frozenset(
    ("unknown-name", "unknown-function", "wrong-argument-count", "unsafe-pattern", "wrong-argument")
)
"""The codes of what can't even be compiled."""


@dataclass(frozen=True)
class Declarations:
    """What is declared around an expression; None where that is not known.

    `context` and `events` hold JSON Schemas, of the keys and of the events' data (None: of any kind).
    """

    context: Mapping[str, Any] | None = None
    events: Mapping[str, Any] | None = None
    phrases: Collection[str] | None = None
    answers: Collection[str] | None = None
    states: Collection[str] | None = None


class ExpressionFindings:
    """Collects what is wrong, each thing once."""

    def __init__(self) -> None:
        self.found: dict[ExpressionFinding, None] = {}

    def report(self, code: str, node: ExpressionNode, message: str, hint: str = "", offset: int | None = None) -> None:
        """Something is wrong with the node, or with its part from `offset` on."""
        start = node.offset if offset is None else offset
        self.found[ExpressionFinding(code, start, max(1, node.end - start), message, hint)] = None

    def expect(self, node: ExpressionNode, kinds: frozenset[str], wanted: frozenset[str], whose: str) -> bool:
        """Whether a value of these kinds can be of one that is wanted, saying so where it can't."""
        if kinds & wanted:
            return True
        self.report("type-mismatch", node, f"this is {in_words(kinds)}, and {in_words(wanted)} is needed {whose}")
        return False


def in_words(kinds: frozenset[str]) -> str:
    """`a number or null`."""
    return " or ".join(words for kind, words in KIND_DESCRIPTIONS.items() if kind in kinds)
