"""A controller file under construction, with another tool's variables, terms and rules under valid names."""

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from math import inf, isfinite, isnan
from typing import Any, assert_never
from unicodedata import normalize

from lumen.features.formats_fuzzy.fll.fuzzylite_names import plain
from lumen.features.formats_fuzzy.fll.rule_text import rule_text
from lumen.language.controllers import (
    TERM_PARAMETERS,
    Antecedent,
    Conjunction,
    Disjunction,
    Negation,
    Proposition,
)
from lumen.language.counts import counted
from lumen.language.diagnostics import Place
from lumen.project.document_report import DocumentReport
from lumen.project.formats.conversion_findings import LOST, ConversionFindings, ForeignFileError, broken
from lumen.project.formats.unused_names import unused_name
from lumen.project.plain import plain_document
from lumen.project.rule_parser import KEYWORDS, Mention, RuleSyntaxError, RuleWord, parse_rule
from lumen.project.terms import build_terms

_UNFIT = re.compile(r"[^\w\-]+")
_ENDLESS = ("triangle", "trapezoid", "binary", "rectangle")

MAX_TERM_PARAMETERS = 1_000
"""The most parameters of a term: a shape drawn by a person has fewer points."""

NewNames = dict[str, str]
PlaceOfWord = Callable[[RuleWord], Place]
"""Returns the place of a rule's word in the file."""


class ControllerDraft:
    """Collects a controller's data.

    `names` maps the file's variable names to Lumen's, and `terms` maps the term names of each variable. Variables with
    the same name stay separate: a proposition refers to the first one that has its term. In a condition, inputs precede
    outputs.
    """

    def __init__(self, file: str, findings: ConversionFindings) -> None:
        self.file, self.findings = file, findings
        self.places: dict[str, Place] = {}
        self.data: dict[str, Any] = {"description": f"From {file.replace(chr(92), '/').rpartition('/')[2]}"}
        self.sides: dict[str, dict[str, dict[str, Any]]] = {"inputs": {}, "outputs": {}}
        self.names: NewNames = {}
        self.called: dict[str, dict[str, list[str]]] = {"inputs": {}, "outputs": {}}
        self.terms: dict[str, NewNames] = {}
        self.blocks: list[dict[str, Any]] = []
        self._named: dict[int, str] = {}

    def variable(self, side: str, name: str, place: Place) -> dict[str, Any]:
        """Add an input or output, and return its empty data for the caller to fill."""
        known = {*self.sides["inputs"], *self.sides["outputs"]}
        ours = self.fresh(name, known, place)
        self.names.setdefault(name, ours)
        self.called[side].setdefault(name, []).append(ours)
        self.terms[ours] = {}
        spec: dict[str, Any] = {}
        self.places[ours] = place
        self._named[id(spec)] = ours
        self.sides[side][ours] = spec
        return spec

    def own_terms(self, spec: dict[str, Any]) -> NewNames:
        """Return the map from the file's names of a variable's terms to Lumen's."""
        return self.terms[self._named[id(spec)]]

    def fresh(self, name: str, taken: Collection[str], place: Place) -> str:
        """Return a similar name that is valid in Lumen's rules and not in `taken`; report any difference."""
        stem = _UNFIT.sub("_", normalize("NFC", name)).strip("-") or "unnamed"
        stem = f"{stem}_" if stem.lower() in KEYWORDS else stem
        ours = unused_name(stem, taken.__contains__, len(taken))
        if ours != name:
            reason = "that name is already used" if stem == name else "rules can't contain that name"
            self.findings.changed(place, f"`{name}` is renamed to `{ours}`", reason)
        return ours

    def term(self, variable: str, spec: dict[str, Any], name: str, kind: str, values: Any, place: Place) -> None:
        """Add a variable's term, or report why it is left out.

        `values` are the parameters in Lumen's order, optionally followed by a height, or the formula.
        """
        if problem := self._problem(kind, values):
            self.findings.lost(place, f"the term `{name}` of `{variable}` is left out: {problem}")
            return
        terms = spec.setdefault("terms", {})
        ours = self.fresh(name, terms, place)
        self.own_terms(spec)[name] = ours  # FuzzyLite's rules use the last term with a name
        height = None
        if kind not in ("function", "constant", "linear", "discrete") and len(values) == len(TERM_PARAMETERS[kind]) + 1:
            *values, height = values
        shape = {kind: _shape(kind, values)} | ({} if height in (None, 1.0) else {"height": plain(height)})
        if problem := _refused(ours, shape, len(values)):
            self.findings.lost(place, f"the term `{name}` of `{variable}` is left out: {problem}")
            del self.own_terms(spec)[name]
        else:
            terms[ours] = shape

    def _problem(self, kind: str, values: Any) -> str:
        if kind == "function":
            return ""
        if any(isnan(value) for value in values) or (kind not in _ENDLESS and not all(map(isfinite, values))):
            return "a parameter is not a number"
        if len(values) > MAX_TERM_PARAMETERS:
            return f"it has more than {MAX_TERM_PARAMETERS:,} numbers"
        wanted = TERM_PARAMETERS[kind]
        fits = len(values) - len(wanted) in (0, 1) or kind in ("linear", "discrete")
        if kind == "discrete" and (len(values) < 2 or len(values) % 2):
            fits = False
        return (
            "" if fits else f"it has {counted(len(values), 'parameter')} instead of {len(wanted)} ({', '.join(wanted)})"
        )

    def rule(self, text: str, place: Place, spot: PlaceOfWord) -> str:
        """Return the rule's text with Lumen's names; report an invalid rule and return an empty text."""
        try:
            said = parse_rule(text)
        except RuleSyntaxError as error:
            self.findings.lost(spot(error.word), f"this rule is left out: {error.message}", error.hint)
            return ""
        wrong = next((word for mention in said.mentions if (word := self._unknown(mention))), None)
        if wrong:
            self.findings.lost(spot(wrong), f"this rule is left out: unknown name `{wrong.text}`")
            return ""
        concluded = [self._ours(one, concluded=True) for one in said.consequents]
        return rule_text(self._asked(said.antecedent), concluded, said.weight)

    def _asked(self, node: Antecedent) -> Antecedent:
        """Return the condition with Lumen's names."""
        match node:
            case Proposition():
                return self._ours(node, concluded=False)
            case Negation(operand):
                return Negation(self._asked(operand))
            case Conjunction(left, right):
                return Conjunction(self._asked(left), self._asked(right))
            case Disjunction(left, right):
                return Disjunction(self._asked(left), self._asked(right))
        assert_never(node)

    def _ours(self, node: Proposition, *, concluded: bool) -> Proposition:
        variable = self._meant(node.variable, node.term, concluded=concluded)
        return replace(node, variable=variable, term=self.terms[variable].get(node.term, node.term))

    def _meant(self, name: str, term: str, *, concluded: bool) -> str:
        """Return Lumen's name for a proposition's variable, or empty if it is unknown."""
        found = [] if concluded else self.called["inputs"].get(name, [])
        found = [*found, *self.called["outputs"].get(name, [])]
        return next((ours for ours in found if term in self.terms[ours]), found[0] if found else "")

    def _unknown(self, mention: Mention) -> RuleWord | None:
        """Return the word in a proposition that is an unknown variable or term, or None."""
        variable, term = mention.variable, mention.term
        name = self._meant(variable.text, term.text if term else "", concluded=mention.concluded)
        if not name:
            return variable
        return term if term and term.text not in self.terms[name] else None

    def result(self) -> dict[str, Any]:
        """Return the file's data. A single rule block is at the top level; several have names under `blocks`.

        Raises ForeignFileError if no output or no rule is left.
        """
        outputs = self.sides["outputs"]
        if not any(spec.get("terms") for spec in outputs.values()):
            raise self._empty("no output is left", "add an output with terms")
        for name in [name for name, spec in outputs.items() if not spec.get("terms")]:
            del outputs[name]
            self.findings.lost(self.places[name], f"the output `{name}` is left out: it has no terms")
        data = {**self.data, **{side: specs for side, specs in self.sides.items() if specs}}
        blocks = [block for block in self.blocks if block["rules"]]
        if not blocks:
            raise self._empty("no rule is left", "write a rule: if INPUT is TERM then OUTPUT is TERM")
        if len(blocks) == 1:
            data["rules"] = blocks[0]["rules"]
            if blocks[0]["operators"]:
                data["operators"] = blocks[0]["operators"]
        elif blocks:
            named: dict[str, Any] = {}
            for block in blocks:
                name = _UNFIT.sub("_", block["name"]) or f"block{len(named) + 1}"
                while name in named:
                    name += "_"
                named[name] = {key: block[key] for key in ("operators", "rules") if block[key]}
            data["blocks"] = named
        return data

    def _empty(self, what: str, hint: str) -> ForeignFileError:
        """Return the error for an empty controller, placed at the first part that was left out, if any."""
        first = next((d for d in self.findings.diagnostics if d.code == LOST), None)
        if first is None:
            return broken(Place(self.file), "not-a-controller", f"nothing is written: {what}", hint)
        return broken(first.place, "not-a-controller", f"nothing is written: {what} ({first.message})", hint)


def _refused(name: str, shape: Mapping[str, Any], count: int) -> str:
    """Return the first problem that Lumen's loader finds in a term, or empty.

    A formula is not checked, since its variables may be read later.
    """
    if "function" in shape:
        return ""
    document, _ = plain_document("term", {name: dict(shape)})
    assert document is not None  # it has at most MAX_TERM_PARAMETERS
    report = DocumentReport(document)
    build_terms({name: shape}, report, (), count)
    return report.diagnostics[0].message if report.diagnostics else ""


def ranged(low: float, high: float) -> list[int | float]:
    """Return a range as a list for YAML, with whole numbers as integers."""
    return [low if low == -inf else plain(low), high if high == inf else plain(high)]


def _shape(kind: str, values: Any) -> Any:
    if kind == "function":
        return values
    numbers = [value if value in (inf, -inf) else plain(value) for value in values]
    if kind == "constant":
        return numbers[0]
    return [list(pair) for pair in zip(numbers[::2], numbers[1::2], strict=True)] if kind == "discrete" else numbers


def operators(said: Mapping[str, Any], usual: Mapping[str, Any]) -> dict[str, Any]:
    """Return the operators that are set and differ from the defaults."""
    return {key: value for key, value in said.items() if value is not None and value != usual.get(key)}
