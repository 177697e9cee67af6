"""The findings about an expression, their codes, and the declarations that the expression is checked against."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.expressions.kinds import KIND_DESCRIPTIONS
from lumen.expressions.own_functions import KnownFunctions
from lumen.expressions.tree import ExpressionNode
from lumen.language.diagnostics import ERROR, Code

UNKNOWN_CONTEXT_KEY = Code(
    "unknown-context-key", "references", ERROR, "an expression uses a key that `context` does not declare"
)
UNKNOWN_FIELD = Code(
    "unknown-field", "references", ERROR, "an expression uses a field that the messages of the route do not have"
)
UNKNOWN_STATE = Code("unknown-state", "references", ERROR, "the named state does not exist")
EXPRESSION_SYNTAX = Code("expression-syntax", "expressions", ERROR, "an expression can't be read")
TYPE_MISMATCH = Code("type-mismatch", "expressions", ERROR, "an expression combines values of incompatible types")
IMPURE_FUNCTION = Code(
    "impure-function", "expressions", ERROR, "a function of the project reads something other than its arguments"
)
MISPLACED_DRAW = Code("misplaced-draw", "expressions", ERROR, "`shuffle` or `pick` is used outside `assign`")
UNGUARDED_FIELD = Code(
    "unguarded-field", "expressions", ERROR, "an expression reads a field that some of its events do not have"
)
UNKNOWN_ANSWERS = Code("unknown-answers", "expressions", ERROR, "the named answers table is not in the file")
UNKNOWN_FUNCTION = Code("unknown-function", "expressions", ERROR, "an expression calls a function that does not exist")
UNKNOWN_NAME = Code("unknown-name", "expressions", ERROR, "an expression uses a name that does not exist")
UNKNOWN_PHRASE = Code("unknown-phrase", "expressions", ERROR, "the named phrases are not in the file")
UNSAFE_PATTERN = Code("unsafe-pattern", "expressions", ERROR, "a pattern of `matches` could run for ever")
WRONG_ARGUMENT = Code("wrong-argument", "expressions", ERROR, "a function gets a value that it can't use")
WRONG_ARGUMENT_COUNT = Code(
    "wrong-argument-count", "expressions", ERROR, "a function gets too few or too many arguments"
)


class ExpressionFinding(NamedTuple):
    """A fault of an expression."""

    code: Code
    offset: int
    """The place of the fault in the source [characters], from 0."""
    length: int
    """The number of characters to mark."""
    message: str
    hint: str = ""


CODES_OF_COMPILE_ERRORS = frozenset(
    (UNKNOWN_NAME, UNKNOWN_FUNCTION, WRONG_ARGUMENT_COUNT, UNSAFE_PATTERN, WRONG_ARGUMENT)
)
"""The codes of findings that keep an expression from being compiled."""


@dataclass(frozen=True)
class Declarations:
    """The declarations that an expression can refer to; None for each kind that is unknown."""

    context: Mapping[str, Any] | None = None
    """Keys of the context, with the JSON Schema of each."""

    events: Mapping[str, Any] | None = None
    """Names of events, with the JSON Schema of the data of each; None for data of any kind."""

    phrases: Collection[str] | None = None
    answers: Collection[str] | None = None
    states: Collection[str] | None = None
    lists: Mapping[str, Any] | None = None
    """Names of lists, with the JSON Schema of each."""

    variables: Mapping[str, Any] = field(default_factory=dict)
    """Names of entries of lists, or of the arguments of a function, with the JSON Schema of each."""

    functions: KnownFunctions = field(default_factory=dict)
    """The project's own functions."""

    pure: bool = False
    """Whether the expression is the body of a function, which can read only its arguments."""


class ExpressionFindings:
    """A collection of findings, each kept once, in the order of the reports."""

    def __init__(self) -> None:
        self.found: dict[ExpressionFinding, None] = {}

    def report(self, code: Code, node: ExpressionNode, message: str, hint: str = "", offset: int | None = None) -> None:
        """Add a finding about the node, or about its part from `offset` on."""
        start = node.offset if offset is None else offset
        self.found[ExpressionFinding(code, start, max(1, node.end - start), message, hint)] = None

    def expect(self, node: ExpressionNode, kinds: frozenset[str], wanted: frozenset[str], whose: str) -> bool:
        """Return True if one of `kinds` is in `wanted`; otherwise report a type mismatch."""
        if kinds & wanted:
            return True
        self.report(TYPE_MISMATCH, node, f"this is {in_words(kinds)}, but {in_words(wanted)} is needed {whose}")
        return False


def in_words(kinds: frozenset[str]) -> str:
    """Return the kinds as words, such as `a number or null`."""
    return " or ".join(words for kind, words in KIND_DESCRIPTIONS.items() if kind in kinds)
