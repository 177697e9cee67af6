"""Parse a fuzzy rule: `if FaceXLoc is very Negative and not (A is B or C is D) then AngleX is Positive with 0.5`.

`and` binds tighter than `or`, `not` tighter than both; keywords and hedges may be written in capitals. Several
consequents are joined by `and` or a comma. The parser does not check names: it returns each word that should name a
variable or a term with its offset, so that the caller can check it.
"""

import re
from collections.abc import Callable
from typing import NamedTuple

from lumen.language.controllers import HEDGES, Antecedent, Conjunction, Disjunction, Negation, Proposition
from lumen.language.diagnostics import did_you_mean

KEYWORDS = frozenset(("if", "then", "is", "and", "or", "with", *HEDGES))
MAX_RULE_DEPTH = 50
MAX_PROPOSITIONS = 200

_TOKEN = re.compile(r"[(),]|[^\s(),]+")


class RuleWord(NamedTuple):
    """A word of the rule and the offset at which it begins."""

    text: str
    offset: int

    @property
    def key(self) -> str:
        """The word in lower case, for comparison with keywords."""
        return self.text.lower()


class Mention(NamedTuple):
    """The names in one proposition, such as `FaceXLoc is very Negative`."""

    variable: RuleWord
    term: RuleWord | None
    """None after `any`, which needs no term."""
    concluded: bool
    """True if the proposition comes after `then`."""


class RuleText(NamedTuple):
    """The parsed rule, and the words in it that are names."""

    antecedent: Antecedent
    consequents: tuple[Proposition, ...]
    weight: float
    """The rule's weight from 0 to 1; 1 if the rule has no `with`."""
    mentions: tuple[Mention, ...]


class RuleSyntaxError(Exception):
    """Raised if a text is not a rule; `word` is the first wrong word, empty if the rule ends too early."""

    def __init__(self, message: str, word: RuleWord, hint: str = "") -> None:
        super().__init__(message)
        self.message, self.word, self.hint = message, word, hint


def parse_rule(text: str) -> RuleText:
    """Return the parsed rule. Raises RuleSyntaxError if the text is not a rule."""
    return _Parser(text).rule()


class _Parser:
    def __init__(self, text: str) -> None:
        self.words = [RuleWord(match[0], match.start()) for match in _TOKEN.finditer(text)]
        self.end = RuleWord("", len(text.rstrip()))
        self.next = 0
        self.depth = 0
        self.mentions: list[Mention] = []

    @property
    def word(self) -> RuleWord:
        return self.words[self.next] if self.next < len(self.words) else self.end

    def take(self) -> RuleWord:
        word = self.word
        self.next += 1
        return word

    def accept(self, *keys: str) -> bool:
        if self.word.key in keys:
            self.next += 1
            return True
        return False

    def expect(self, key: str, hint: str = "") -> None:
        if not self.accept(key):
            raise self.error(f"`{key}`", hint)

    def error(self, wanted: str, hint: str = "") -> RuleSyntaxError:
        word = self.word
        found = f"not `{word.text}`" if word.text else "but the rule ends"
        return RuleSyntaxError(f"expected {wanted} here, {found}", word, hint)

    def rule(self) -> RuleText:
        self.expect("if", "write a rule as: if INPUT is TERM then OUTPUT is TERM")
        antecedent = self.disjunction()
        near = did_you_mean(self.word.text, ("and", "or", "then")) if self.word.text else ""
        self.expect(
            "then", near if near.startswith("did") else "join conditions with `and` or `or`, and end them with `then`"
        )
        consequents = [self.proposition(concluded=True)]
        while self.accept("and", ","):
            consequents.append(self.proposition(concluded=True))
        weight = self.weight() if self.accept("with") else 1.0
        if self.word.text:
            raise self.error("the end of the rule, `and` or `with`", "write a weight as: with 0.5")
        return RuleText(antecedent, tuple(consequents), weight, tuple(self.mentions))

    def disjunction(self) -> Antecedent:
        return self.joined("or", self.conjunction, Disjunction)

    def conjunction(self) -> Antecedent:
        return self.joined("and", self.operand, Conjunction)

    def joined(
        self, key: str, operand: Callable[[], Antecedent], join: Callable[[Antecedent, Antecedent], Antecedent]
    ) -> Antecedent:
        left = operand()
        while self.accept(key):
            if len(self.mentions) >= MAX_PROPOSITIONS:
                raise RuleSyntaxError(f"the rule has more than {MAX_PROPOSITIONS} conditions", self.word, "split it")
            left = join(left, operand())
        return left

    def operand(self) -> Antecedent:
        self.depth += 1
        if self.depth > MAX_RULE_DEPTH:
            raise RuleSyntaxError("the rule is nested too deeply", self.word, "use fewer brackets")
        inner = self.negation() if self.accept("not") else self.bracket() if self.accept("(") else self.proposition()
        self.depth -= 1
        return inner

    def negation(self) -> Antecedent:
        operand = self.operand()
        if isinstance(operand, Proposition):
            return Proposition(operand.variable, operand.term, ("not", *operand.hedges))
        return Negation(operand)

    def bracket(self) -> Antecedent:
        inner = self.disjunction()
        self.expect(")", "close every `(` with `)`")
        return inner

    def proposition(self, concluded: bool = False) -> Proposition:
        variable = self.name("the name of an output" if concluded else "the name of an input")
        self.expect("is", f"write: {variable.text} is TERM")
        hedges = []
        while self.word.key in HEDGES:
            hedges.append(self.take().key)
        bare = bool(hedges) and hedges[-1] == "any" and not concluded
        term = None if bare else self.name(f"a term of `{variable.text}`")
        self.mentions.append(Mention(variable, term, concluded))
        return Proposition(variable.text, term.text if term else "", tuple(hedges))

    def name(self, wanted: str) -> RuleWord:
        if not self.word.text or self.word.text in "()," or self.word.key in KEYWORDS:
            raise self.error(wanted)
        return self.take()

    def weight(self) -> float:
        word = self.word
        try:
            weight = float(word.text)
        except ValueError:
            raise self.error("the rule's weight", "write a number from 0 to 1") from None
        if not 0.0 <= weight <= 1.0:
            raise RuleSyntaxError(
                f"the weight {word.text} is not between 0 and 1", word, "write, for example, with 0.5"
            )
        self.next += 1
        return weight
