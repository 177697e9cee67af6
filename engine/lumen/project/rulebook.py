"""Read the rules of a fuzzy controller, in blocks, and check each name in them against the variables."""

from collections.abc import Mapping
from typing import Any

from lumen.language.controllers import Activation, Operators, Rule, RuleBlock, Variable
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.project.document_report import DocumentReport
from lumen.project.rule_parser import Mention, RuleSyntaxError, RuleWord, parse_rule
from lumen.project.word_places import report_word

NO_RULES = Code("no-rules", "controllers", ERROR, "a controller has no rules")
NOT_AN_OUTPUT = Code("not-an-output", "controllers", ERROR, "a rule sets a variable that is not an output")
RULE_SYNTAX = Code("rule-syntax", "controllers", ERROR, "a rule can't be read")
UNKNOWN_TERM = Code("unknown-term", "controllers", ERROR, "a rule uses a term that the variable does not have")
UNKNOWN_VARIABLE = Code(
    "unknown-variable", "controllers", ERROR, "a rule or a binding uses a variable that does not exist"
)


class Rulebook:
    """Reads the rules of one file; `inputs` and `outputs` are the usable variables.

    A name is reported as unknown only if the file does not have it. A rule with the name of a broken variable or term
    is left out without a report, because that fault was reported already.
    """

    def __init__(
        self,
        data: Mapping[str, Any],
        report: DocumentReport,
        inputs: Mapping[str, Variable],
        outputs: Mapping[str, Variable],
    ) -> None:
        self.data, self.report = data, report
        self.built = {"inputs": inputs, "outputs": outputs}
        self.operators = data.get("operators") or {}

    def blocks(self) -> list[RuleBlock]:
        """Return the rules under `rules:`, then those of each of `blocks:`; report a controller without rules."""
        own = RuleBlock(tuple(self.rules(("rules",), self.data.get("rules") or ())), self.combination({}))
        blocks = [own] if own.rules else []
        for name, spec in (self.data.get("blocks") or {}).items():
            rules = tuple(self.rules(("blocks", name, "rules"), spec.get("rules") or ()))
            blocks.append(RuleBlock(rules, self.combination(spec.get("operators") or {}), name))
        if not any(block.rules for block in blocks) and not self.report.diagnostics:
            self.report(NO_RULES, (), "the controller has no rules", hint="add `rules:` with a list of rules")
        return blocks

    def combination(self, differing: Mapping[str, Any]) -> Operators:
        """Return the operators of a block: the file's, except for those that `differing` replaces."""
        operators = {**self.operators, **differing}
        names = ("conjunction", "disjunction", "implication")
        given = {name: operators[name] for name in names if name in operators}
        activation = operators.get("activation") or {}
        return Operators(**given, activation=Activation(**activation) if "method" in activation else Activation())

    def rules(self, path: NodePath, texts: Any) -> list[Rule]:
        found = (self.rule((*path, i), text) for i, text in enumerate(texts))
        return [rule for rule in found if rule]

    def rule(self, path: NodePath, text: str) -> Rule | None:
        try:
            said = parse_rule(text)
        except RuleSyntaxError as error:
            self.at_word(RULE_SYNTAX, path, text, error.word, error.message, error.hint)
            return None
        known = [self.mentioned(path, text, mention) for mention in said.mentions]
        return Rule(said.antecedent, said.consequents, said.weight, text, path) if all(known) else None

    def mentioned(self, path: NodePath, text: str, mention: Mention) -> bool:
        """Return True if both names of a proposition can be used; report those that are unknown."""
        word, term = mention.variable, mention.term
        side = "outputs" if mention.concluded or word.text not in self.data["inputs"] else "inputs"
        spec = self.data[side].get(word.text)
        if spec is None:
            self.unknown_variable(path, text, mention)
            return False
        terms = spec.get("terms", {})
        if term and term.text not in terms:
            hint = did_you_mean(term.text, terms, f"`{word.text}` has")
            self.at_word(UNKNOWN_TERM, path, text, term, f"`{word.text}` has no term `{term.text}`", hint)
            return False
        variable = self.built[side].get(word.text)
        return variable is not None and (term is None or term.text in variable.terms)

    def unknown_variable(self, path: NodePath, text: str, mention: Mention) -> None:
        word = mention.variable
        if mention.concluded and word.text in self.data["inputs"]:
            hint = did_you_mean(word.text, self.data["outputs"], "the outputs are")
            message = f"`{word.text}` is an input, but `then` needs an output"
            self.at_word(NOT_AN_OUTPUT, path, text, word, message, hint)
            return
        names = [*([] if mention.concluded else self.data["inputs"]), *self.data["outputs"]]
        hint = did_you_mean(word.text, names, "the variables are")
        self.at_word(UNKNOWN_VARIABLE, path, text, word, f"there is no variable `{word.text}`", hint)

    def at_word(self, code: Code, path: NodePath, text: str, word: RuleWord, message: str, hint: str) -> None:
        """Report a finding about one word of a rule."""
        report_word(self.report, code, path, text, word.offset, len(word.text), message, hint)
