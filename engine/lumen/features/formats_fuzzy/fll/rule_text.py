"""Writes a rule's text from its condition, conclusions and weight."""

from collections.abc import Iterator, Mapping, Sequence
from typing import assert_never

from lumen.features.formats_fuzzy.fll.fuzzylite_names import written
from lumen.language.controllers import Antecedent, Conjunction, Disjunction, Negation, Proposition

_NOBODY: Mapping[str, str] = {}


def rule_text(
    antecedent: Antecedent,
    consequents: Sequence[Proposition],
    weight: float,
    names: Mapping[str, str] = _NOBODY,
    terms: Mapping[str, Mapping[str, str]] | None = None,
) -> str:
    """Return `if … then … with …`, without `with` for a weight of 1.

    `names` and `terms` map variables and their terms to the names to write.
    """

    def said(node: Proposition) -> str:
        term = (terms or {}).get(node.variable, _NOBODY).get(node.term, node.term)
        return " ".join(word for word in (names.get(node.variable, node.variable), "is", *node.hedges, term) if word)

    def text(node: Antecedent) -> str:
        match node:
            case Proposition():
                return said(node)
            case Negation(operand):
                return f"not ({text(operand)})"
            case Conjunction(left, right):
                return f"{inner(left, Disjunction)} and {inner(right, (Disjunction, Conjunction))}"
            case Disjunction(left, right):
                return f"{text(left)} or {inner(right, Disjunction)}"
        assert_never(node)

    def inner(node: Antecedent, weaker: type | tuple[type, ...]) -> str:
        return f"({text(node)})" if isinstance(node, weaker) else text(node)

    suffix = "" if weight == 1.0 else f" with {written(weight)}"
    return f"if {text(antecedent)} then {' and '.join(map(said, consequents))}{suffix}"


def negations(node: Antecedent) -> Iterator[Negation]:
    """Yield every `not ( … )` in a condition, at any depth."""
    match node:
        case Negation(operand):
            yield node
            yield from negations(operand)
        case Conjunction(left, right) | Disjunction(left, right):
            yield from negations(left)
            yield from negations(right)
