"""Explanations of a controller's outputs: every number between the inputs and the outputs."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import reduce

from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.defuzzifiers import midpoints, sampled
from lumen.fuzzy.evaluator import Evaluator
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.norms import norm
from lumen.language.controllers import Rule, Variable


@dataclass(frozen=True)
class Concluded:
    """The rules' conclusions about an output."""

    degrees: Mapping[str, float]
    """The degree of each term."""
    value: float
    """The value, in the output's unit."""
    fired: bool
    """False if `value` is the default or the previous value, because no rule fired."""
    points: tuple[float, ...] = field(default=(), repr=False)
    """Points in the output's unit; empty for weighted defuzzifiers."""
    memberships: tuple[float, ...] = field(default=(), repr=False)
    """The memberships of the aggregated set at these points."""


@dataclass(frozen=True)
class Explanation:
    """Every number between the inputs and the outputs of an evaluation."""

    inputs: Mapping[str, float]
    memberships: Mapping[str, Mapping[str, float]]
    """The degree of each term, by input and term."""
    rules: tuple[tuple[Rule, float], ...]
    """Each rule with its degree."""
    outputs: Mapping[str, Concluded]
    """The conclusions about each output."""


def explain(
    evaluator: Evaluator, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None
) -> Explanation:
    """Return every number between these inputs and the outputs; raises the same errors as `evaluate`."""
    controller, program = evaluator.controller, evaluator.program
    values = evaluator.evaluate(inputs, previous)
    tape = program.run([float(inputs[name]) for name in controller.inputs])
    memberships = {
        name: {key: float(membership(NUMBERS, term)(float(inputs[name]))) for key, term in variable.terms.items()}
        for name, variable in controller.inputs.items()
    }
    rules = tuple((rule, float(tape[slot])) for rule, slot in zip(controller.rules, program.rules, strict=True))
    outputs = {
        name: _concluded(
            variable, [(c.term, float(tape[c.slot]), c.implication) for c in program.conclusions[name]], values[name]
        )
        for name, variable in controller.outputs.items()
    }
    return Explanation(dict(inputs), memberships, rules, outputs)


def _concluded(variable: Variable, conclusions: list[tuple[str, float, str]], value: float) -> Concluded:
    aggregate = norm(NUMBERS, variable.aggregation)
    degrees: dict[str, float] = {}
    for term, degree, _ in conclusions:
        degrees[term] = aggregate(degrees[term], degree) if term in degrees else degree
    fired = any(degree > 0.0 for degree in degrees.values())
    if variable.weighted:
        return Concluded(degrees, value, fired)
    points = midpoints(variable)
    parts = [_implied(variable, points, conclusion) for conclusion in conclusions]
    whole = tuple(reduce(aggregate, column, 0.0) for column in zip(*parts, strict=True))
    return Concluded(degrees, value, fired, tuple(points), whole)


def _implied(variable: Variable, points: list[float], conclusion: tuple[str, float, str]) -> list[float]:
    term, degree, implication = conclusion
    imply = norm(NUMBERS, implication)
    return [imply(degree, y) for y in sampled(variable.terms[term], points)]
