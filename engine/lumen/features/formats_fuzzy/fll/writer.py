"""Writes a controller as an engine in FuzzyLite Language (FuzzyLite 8)."""

import re
from collections.abc import Iterator, Mapping

from lumen.features.formats_fuzzy.fll.fuzzylite_names import ACTIVATED, METHODS, NORMS, SHAPES, foreign, written
from lumen.features.formats_fuzzy.fll.infix_formulas import write_formula
from lumen.features.formats_fuzzy.fll.rule_text import negations, rule_text
from lumen.language.controllers import (
    VALUE_TERMS,
    Activation,
    ControllerDefinition,
    Rule,
    RuleBlock,
    Term,
    Variable,
)
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import ExportReport, PlaceOfPath
from lumen.project.formats.unused_names import unused_name

_UNFIT = re.compile(r"[^A-Za-z0-9_]+")


def write_fll(controller: ControllerDefinition, place: PlaceOfPath) -> tuple[str, list[Diagnostic]]:
    """Return the engine's text, and findings about parts that FuzzyLite can't represent."""
    writer = _FllWriter(controller, ExportReport(place))
    return "\n".join(writer.lines()) + "\n", writer.report.diagnostics


class _FllWriter:
    """Writes one controller, with names that are valid in FuzzyLite."""

    def __init__(self, controller: ControllerDefinition, report: ExportReport) -> None:
        self.controller, self.report = controller, report
        variables = {**controller.inputs, **controller.outputs}
        self.names = _fresh(variables)
        self.terms = {name: _fresh(variable.terms) for name, variable in variables.items()}
        for name, variable in variables.items():
            self.renamed(self.names, variable.where, name)
            for term in variable.terms.values():
                self.renamed(self.terms[name], term.where, term.name)

    def renamed(self, names: Mapping[str, str], where: tuple[str | int, ...], name: str) -> None:
        if names[name] != name:
            self.report.changed(
                f"`{name}` is renamed to `{names[name]}`", where, "FuzzyLite's names consist of A-Z, a-z, 0-9 and _"
            )

    def lines(self) -> Iterator[str]:
        controller = self.controller
        yield f"Engine: {_UNFIT.sub('_', controller.name)}"
        if controller.input_bindings or controller.context_inputs or controller.output_bindings or controller.signals:
            message = "the controller's bindings are left out"
            self.report.changed(message, ("bind",), "FuzzyLite only computes numbers")
        for variable in controller.inputs.values():
            yield from self.variable("Input", variable)
        for variable in controller.outputs.values():
            yield from self.variable("Output", variable)
        for block in controller.blocks:
            yield from self.block(block)

    def variable(self, side: str, variable: Variable) -> Iterator[str]:
        yield f"{side}Variable: {self.names[variable.name]}"
        yield "  enabled: true"
        yield f"  range: {written(variable.minimum)} {written(variable.maximum)}"
        yield f"  lock-range: {str(variable.lock_range).lower()}"
        if side == "Output":
            yield from self.output(variable)
        for term in variable.terms.values():
            if shape := self.shape(variable, term):
                yield f"  term: {self.terms[variable.name][term.name]} {shape}"

    def output(self, variable: Variable) -> Iterator[str]:
        weighted = variable.weighted
        usual = weighted and variable.aggregation == "unbounded-sum"
        yield f"  aggregation: {'none' if usual else foreign(NORMS, variable.aggregation)}"
        method = foreign(METHODS, variable.defuzzifier)
        yield f"  defuzzifier: {method}" if weighted else f"  defuzzifier: {method} {variable.resolution}"
        yield f"  default: {'nan' if variable.default is None else written(variable.default)}"
        yield f"  lock-previous: {str(variable.lock_previous).lower()}"
        if weighted and len({term.kind in (*VALUE_TERMS, "function") for term in variable.terms.values()}) > 1:
            message = f"`{variable.name}` mixes terms that have a value with terms that are inverted"
            self.report.lost(f"{message}, which FuzzyLite does not allow", variable.where, "split it into two outputs")

    def shape(self, variable: Variable, term: Term) -> str:
        parameters = [written(value) for value in term.parameters]
        if term.kind == "function":
            text, chose = write_formula(term.formula, self.names)
            if chose:
                message = f"the conditional values in `{term.name}` of `{variable.name}` are written as sums"
                self.report.changed(
                    message, (*term.where, "function"), "if one branch has no value, the sum has no value"
                )
            parameters = [text]
        elif term.kind == "linear":
            parameters += ["0"] * (len(self.controller.inputs) + 1 - len(parameters))
        if term.height != 1.0:
            if term.kind in (*VALUE_TERMS, "function"):
                self.report.lost(f"the height is left out: FuzzyLite has none for `{term.kind}`", term.where)
            else:
                parameters.append(written(term.height))
        return " ".join([foreign(SHAPES, term.kind), *parameters])

    def block(self, block: RuleBlock) -> Iterator[str]:
        operators = block.operators
        yield f"RuleBlock: {_UNFIT.sub('_', block.name)}".rstrip()
        yield "  enabled: true"
        yield f"  conjunction: {foreign(NORMS, operators.conjunction)}"
        yield f"  disjunction: {foreign(NORMS, operators.disjunction)}"
        yield f"  implication: {foreign(NORMS, operators.implication)}"
        yield f"  activation: {_activation(operators.activation)}"
        for rule in block.rules:
            if self.sayable(rule):
                text = rule_text(rule.antecedent, rule.consequents, rule.weight, self.names, self.terms)
                yield f"  rule: {text}"

    def sayable(self, rule: Rule) -> bool:
        if any(True for _ in negations(rule.antecedent)):
            self.report.lost("FuzzyLite has no `not ( … )`: this rule is left out", rule.where, "negate each term")
            return False
        return True


def _activation(activation: Activation) -> str:
    name = foreign(ACTIVATED, activation.method)
    match activation.method:
        case "first" | "last":
            return f"{name} {activation.rules} {written(activation.threshold)}"
        case "highest" | "lowest":
            return f"{name} {activation.rules}"
        case "threshold":
            return f"{name} {activation.comparison} {written(activation.threshold)}"
    return name


def _fresh(names: Mapping[str, object]) -> dict[str, str]:
    """Map each name to a unique one that is valid in FuzzyLite."""
    found: dict[str, str] = {}
    for name in names:
        stem = _UNFIT.sub("_", name) or "_"
        found[name] = unused_name(stem, lambda clean: clean in found.values(), len(found))
    return found
