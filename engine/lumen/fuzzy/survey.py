"""A coarse survey of a controller's surface: each output as a function of one input.

It uses plain Python and few points, so that lint can afford it: at most 200 points of a set, 65 of an input's range.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import isfinite, isnan, nan
from typing import NamedTuple

from lumen.expressions import parse_expression
from lumen.expressions.tree import Identifier, walk
from lumen.fuzzy.evaluator import Evaluator
from lumen.language.controllers import (
    Antecedent,
    Conjunction,
    ControllerDefinition,
    Disjunction,
    Negation,
    Proposition,
    Term,
    Variable,
)

SLICE_POINTS = 65
SURVEY_RESOLUTION = 200
STEP_HALVINGS = 14


class Slice(NamedTuple):
    """An output as a function of one input, the other inputs being at rest."""

    output: str
    input: str
    xs: tuple[float, ...]
    """Values of the input over its range, ascending."""
    ys: tuple[float, ...]
    """The output at each of them; NaN if no rule fires."""


class SurfaceJump(NamedTuple):
    """A jump of an output between two almost equal values of an input."""

    x: float
    """The input's value just before the jump."""
    low: float
    """The output before the jump."""
    high: float
    """The output after the jump, which may be lower."""


class Survey:
    """A controller that can be evaluated point by point; inputs not given have their resting values."""

    def __init__(self, controller: ControllerDefinition, resolution: int = SURVEY_RESOLUTION) -> None:
        self.controller = controller
        self._evaluator = Evaluator(silent(controller, resolution))
        self.neutral_inputs = {name: resting(variable) for name, variable in controller.inputs.items()}

    def at(self, changed: Mapping[str, float]) -> dict[str, float]:
        """Return the outputs for these inputs, NaN if no rule fires; the other inputs rest."""
        return self._evaluator.evaluate({**self.neutral_inputs, **changed})

    def slices(self) -> Iterator[Slice]:
        """Yield each output over each input that it depends on and whose range is finite."""
        for name, variable in self.controller.inputs.items():
            outputs = [output for output in self.controller.outputs if name in asked(self.controller, output)]
            if outputs and isfinite(variable.minimum) and isfinite(variable.maximum):
                xs = grid(variable)
                said = [self.at({name: x}) for x in xs]
                for output in outputs:
                    yield Slice(output, name, xs, tuple(point[output] for point in said))

    def step(self, found: Slice, share: float) -> SurfaceJump | None:
        """Return the greatest jump, located by bisection, if it exceeds that share of the output's range; else None."""
        output = self.controller.outputs[found.output]
        least = share * (output.maximum - output.minimum)
        gaps = [(abs(b - a), i) for i, (a, b) in enumerate(zip(found.ys, found.ys[1:], strict=False))]
        _, i = max((gap for gap in gaps if not isnan(gap[0])), default=(0.0, 0))
        low, high, a, b = found.xs[i], found.xs[i + 1], found.ys[i], found.ys[i + 1]
        for _ in range(STEP_HALVINGS):
            if not abs(b - a) > least:
                return None
            middle = (low + high) / 2
            y = self.at({found.input: middle})[found.output]
            low, high, a, b = (middle, high, y, b) if abs(y - a) < abs(b - y) else (low, middle, a, y)
        return SurfaceJump(low, a, b)


def silent(controller: ControllerDefinition, resolution: int) -> ControllerDefinition:
    """Return the controller without defaults and previous values; its sets have at most `resolution` sample points."""
    outputs = {
        name: replace(v, default=nan, lock_previous=False, resolution=min(v.resolution, resolution))
        for name, v in controller.outputs.items()
    }
    return replace(controller, outputs=outputs)


def grid(variable: Variable, points: int = SLICE_POINTS) -> tuple[float, ...]:
    """Return evenly spread values of a variable, including both ends of its range."""
    width = variable.maximum - variable.minimum
    return tuple(variable.minimum + width * i / (points - 1) for i in range(points))


def resting(variable: Variable) -> float:
    """Return a variable's neutral point, else the middle of its range, else 0."""
    middle = (variable.minimum + variable.maximum) / 2
    return variable.neutral if variable.neutral is not None else middle if isfinite(middle) else 0.0


def asked(controller: ControllerDefinition, output: str) -> frozenset[str]:
    """Return the inputs that an output depends on, also indirectly through other outputs."""
    found: set[str] = set()
    waiting, known = [output], {output}
    while waiting:
        for name in _asked(controller, waiting.pop()):
            if name in controller.inputs:
                found.add(name)
            elif name in controller.outputs and name not in known:
                known.add(name)
                waiting.append(name)
    return frozenset(found)


def _asked(controller: ControllerDefinition, output: str) -> Iterator[str]:
    for rule in controller.rules:
        if any(consequent.variable == output for consequent in rule.consequents):
            yield from (proposition.variable for proposition in propositions(rule.antecedent))
    for term in controller.outputs[output].terms.values():
        if term.kind == "linear":
            yield from controller.inputs
        elif term.kind == "function":
            yield from _named(term)


def _named(term: Term) -> Iterator[str]:
    yield from (node.name for node, _ in walk(parse_expression(term.formula)) if isinstance(node, Identifier))


def propositions(node: Antecedent) -> Iterator[Proposition]:
    """Yield the propositions of an antecedent, from left to right."""
    match node:
        case Proposition():
            yield node
        case Negation(operand):
            yield from propositions(operand)
        case Conjunction(left, right) | Disjunction(left, right):
            yield from propositions(left)
            yield from propositions(right)
