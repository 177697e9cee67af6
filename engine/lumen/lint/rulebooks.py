"""Controllers: rules that are redundant, contradict each other, or leave out a case."""

from collections.abc import Iterator, Mapping
from itertools import product

from lumen.fuzzy.survey import propositions
from lumen.language.controllers import (
    Antecedent,
    Conjunction,
    ControllerDefinition,
    Disjunction,
    Negation,
    Proposition,
    Rule,
    RuleBlock,
)
from lumen.language.diagnostics import WARNING, Code
from lumen.project.document_report import DocumentReport

CONTRADICTING_RULE = Code(
    "contradicting-rule", "controllers", WARNING, "two rules have the same condition and different conclusions"
)
DUPLICATE_RULE = Code("duplicate-rule", "controllers", WARNING, "a rule is written twice")
HEDGED_CONCLUSION = Code(
    "hedged-conclusion",
    "controllers",
    WARNING,
    "a hedge in a conclusion changes the degree of the rule, not the set",
)
IDLE_RULE = Code("idle-rule", "controllers", WARNING, "a rule has the weight 0")
MISSING_RULE = Code("missing-rule", "controllers", WARNING, "a table of rules leaves out a case")
SUBSUMED_RULE = Code("subsumed-rule", "controllers", WARNING, "a rule is redundant: another rule already covers it")
UNUSED_TERM = Code("unused-term", "controllers", WARNING, "no rule uses a term")


MAX_SHOWN_CASES = 3
MAX_COMPARISONS = 10_000
"""The maximum number of pairs of rules that are compared, and of table cells that are searched."""


def check(controller: ControllerDefinition, report: DocumentReport) -> None:
    """Report idle, hedged, duplicate, contradicting, subsumed and missing rules, and terms that no rule mentions."""
    for block in controller.blocks:
        _idle(block, report)
        _hedged(block, report)
        _pairs(block, controller, report)
        _missing(block, controller, report)
    _unused(controller, report)


def _idle(block: RuleBlock, report: DocumentReport) -> None:
    for rule in block.rules:
        if rule.weight == 0:
            message, hint = "with the weight 0, this rule has no effect", "write a weight up to 1, or delete the rule"
            report(IDLE_RULE, rule.where, message, hint)


def _hedged(block: RuleBlock, report: DocumentReport) -> None:
    """Report `not` and `any` in conclusions, and other hedges that also change later conclusions of the rule."""
    for rule in block.rules:
        for i, one in enumerate(rule.consequents):
            said = f"`{one.variable} is {' '.join((*one.hedges, one.term))}`"
            behind = rule.consequents[i + 1 :]
            if "any" in one.hedges:
                message = f"{said} always concludes `{one.term}` in full, even if the rule is hardly true"
                report(HEDGED_CONCLUSION, rule.where, message, "delete `any`")
            elif "not" in one.hedges:
                message = (
                    f"{said} concludes `{one.term}` with 1 minus the degree of the rule:"
                    " `not` does not mean the other values here"
                )
                hint = f"give `{one.variable}` a term for what you mean, and use it in the conclusion"
                report(HEDGED_CONCLUSION, rule.where, message, hint)
            elif one.hedges and behind:
                message = f"the hedge in {said} also applies to `{behind[0].variable} is {behind[0].term}` after it"
                report(HEDGED_CONCLUSION, rule.where, message, "write this conclusion last, or in a separate rule")


def _pairs(block: RuleBlock, controller: ControllerDefinition, report: DocumentReport) -> None:
    known: dict[object, Rule] = {}
    conjunctions: dict[Proposition, list[tuple[frozenset[Proposition], Rule]]] = {}
    for rule in block.rules:
        asked, said = _sorted(rule.antecedent), frozenset(rule.consequents)
        if (first := known.get(asked)) is None:
            known[asked] = rule
        elif said == frozenset(first.consequents):
            message, hint = "this rule is written twice", "delete one of them; to weaken a rule, give it a weight"
            report(DUPLICATE_RULE, rule.where, message, hint, related=[(first.where, "the first one")])
        elif clash := _clash(first, rule):
            one, other = clash
            message = f"under the same condition, `{one.variable}` is both `{one.term}` and `{other.term}`"
            hint = "change the condition of one of the two, or delete it"
            wrong, right = _order(block, controller, first, rule)
            report(CONTRADICTING_RULE, wrong.where, message, hint, related=[(right.where, "the other one")])
        parts = _conjunction(rule.antecedent)
        if parts and len(rule.consequents) == 1:
            conjunctions.setdefault(rule.consequents[0], []).append((parts, rule))
    if block.operators.activation.method == "general":
        for concluded, found in conjunctions.items():
            if controller.outputs[concluded.variable].aggregation == "maximum" and len(found) ** 2 <= MAX_COMPARISONS:
                _subsumed(found, report)


def _sorted(node: Antecedent) -> object:
    """Return the antecedent as a value in which the order of `and` and `or` does not matter."""
    match node:
        case Proposition():
            return node
        case Negation(operand):
            return ("not", _sorted(operand))
    sign = "and" if isinstance(node, Conjunction) else "or"
    return (sign, frozenset(_sorted(part) for part in _joined(node, type(node))))


def _joined(node: Antecedent, kind: type) -> Iterator[Antecedent]:
    if isinstance(node, kind) and isinstance(node, Conjunction | Disjunction):
        yield from _joined(node.left, kind)
        yield from _joined(node.right, kind)
    else:
        yield node


def _conjunction(node: Antecedent) -> frozenset[Proposition]:
    """Return the propositions of an antecedent that combines them only by `and`; empty for any other antecedent."""
    parts = list(_joined(node, Conjunction))
    found = frozenset(part for part in parts if isinstance(part, Proposition))
    return found if len(found) == len(parts) else frozenset()


def _order(block: RuleBlock, controller: ControllerDefinition, first: Rule, second: Rule) -> tuple[Rule, Rule]:
    """Return two rules with the same condition: the rule whose condition is probably wrong, then the other rule.

    Rules usually follow the order of the terms. The first rule is wrong if a term without a rule fits in its place,
    else the second.
    """
    asked = first.antecedent
    if isinstance(asked, Proposition) and (variable := controller.inputs.get(asked.variable)):
        alone = [rule.antecedent for rule in block.rules if isinstance(rule.antecedent, Proposition)]
        row = [each.term for each in alone if each.variable == asked.variable]
        terms, at = list(variable.terms), row.index(asked.term)
        if any([*row[:at], missed, *row[at + 1 :]] in (terms, terms[::-1]) for missed in terms):
            return first, second
    return second, first


def _clash(first: Rule, second: Rule) -> tuple[Proposition, Proposition] | None:
    """Return two consequents without hedges that conclude different terms of one variable; None without such a pair."""
    for one, other in product(first.consequents, second.consequents):
        if one.variable == other.variable and one.term != other.term and not one.hedges and not other.hedges:
            return one, other
    return None


def _subsumed(found: list[tuple[frozenset[Proposition], Rule]], report: DocumentReport) -> None:
    """Report rules with more conditions and the same conclusion as another rule: they never change the result."""
    for asked, rule in found:
        wider = next((r for parts, r in found if parts < asked and r.weight >= rule.weight), None)
        if wider:
            hint = "delete it, or change its conclusion"
            message = "this rule adds nothing: another rule has fewer conditions and the same conclusion"
            report(SUBSUMED_RULE, rule.where, message, hint, related=[(wider.where, "that one")])


def _missing(block: RuleBlock, controller: ControllerDefinition, report: DocumentReport) -> None:
    """Report the cells without a rule, in tables of terms of which more than half have a rule."""
    tables: dict[tuple[str, tuple[str, ...]], list[tuple[Rule, Mapping[str, str]]]] = {}
    for rule in block.rules:
        cell = _cell(rule)
        if len(cell) > 1 and all(name in controller.inputs for name in cell):
            for output in dict.fromkeys(consequent.variable for consequent in rule.consequents):
                tables.setdefault((output, tuple(sorted(cell))), []).append((rule, cell))
    for (output, inputs), found in tables.items():
        names = [name for name in controller.inputs if name in inputs]
        cells = 1
        for name in names:
            cells *= len(controller.inputs[name].terms)
        said = {tuple(cell[name] for name in names) for _, cell in found}
        if (
            len(said) * 2 > cells
            and cells <= MAX_COMPARISONS
            and len(said) < cells
            and not _others(block, output, found)
        ):
            gaps = [gap for gap in product(*(controller.inputs[name].terms for name in names)) if gap not in said]
            _absent(output, names, gaps, found[-1][0], report)


def _cell(rule: Rule) -> Mapping[str, str]:
    """Return each variable's term if the antecedent is `a is x and b is y and …` without hedges; else empty."""
    parts = _conjunction(rule.antecedent)
    cell = {part.variable: part.term for part in parts if not part.hedges}
    return cell if len(cell) == len(parts) else {}


def _others(block: RuleBlock, output: str, found: list[tuple[Rule, Mapping[str, str]]]) -> bool:
    """Return whether rules of another form also conclude that output, because these can fill the gaps."""
    cells = {id(rule) for rule, _ in found}
    return any(
        id(rule) not in cells and any(consequent.variable == output for consequent in rule.consequents)
        for rule in block.rules
    )


def _absent(output: str, names: list[str], gaps: list[tuple[str, ...]], last: Rule, report: DocumentReport) -> None:
    shown = [" and ".join(f"{n} is {t}" for n, t in zip(names, gap, strict=True)) for gap in gaps[:MAX_SHOWN_CASES]]
    more = f", and in {len(gaps) - MAX_SHOWN_CASES} more cases" if len(gaps) > MAX_SHOWN_CASES else ""
    message = f"no rule sets `{output}` if {'; or if '.join(shown)}{more}"
    report(MISSING_RULE, last.where, message, f"add this rule below it: if {shown[0]} then {output} is …")


def _unused(controller: ControllerDefinition, report: DocumentReport) -> None:
    if any(diagnostic.code == CONTRADICTING_RULE for diagnostic in report.diagnostics):
        return  # one of the contradicting rules was probably meant for the unused term
    asked = {(p.variable, p.term) for rule in controller.rules for p in propositions(rule.antecedent)}
    asked |= {(p.variable, p.term) for rule in controller.rules for p in rule.consequents}
    for side, variables in (("checks", controller.inputs), ("concludes", controller.outputs)):
        for variable in variables.values():
            for term in variable.terms.values():
                if (variable.name, term.name) not in asked:
                    message = f"no rule {side} `{variable.name} is {term.name}`"
                    cause = f"{report.document.file} term {term.name}"  # a missing rule had it on both sides
                    report(
                        UNUSED_TERM,
                        term.where,
                        message,
                        "write a rule with it, or delete the term",
                        key=True,
                        cause=cause,
                    )
