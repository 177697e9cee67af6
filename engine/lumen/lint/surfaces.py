"""Controllers: their outputs over a coarse grid of inputs, checked against what the file declares."""

from collections.abc import Iterator
from itertools import product
from math import isnan
from operator import itemgetter
from typing import NamedTuple

from lumen.fuzzy.survey import Slice, SurfaceJump, Survey, asked, grid
from lumen.language.controllers import INTEGRAL_DEFUZZIFIERS, WEIGHTED_DEFUZZIFIERS, ControllerDefinition, Variable
from lumen.language.diagnostics import WARNING, Code
from lumen.project.document_report import DocumentReport

ATTAINABLE_RANGE = Code(
    "attainable-range", "controllers", WARNING, "an output uses only a small part of its range, or goes beyond it"
)
COARSE_RESOLUTION = Code(
    "coarse-resolution", "controllers", WARNING, "the resolution of an output is too low for its `accuracy`"
)
NO_DEFAULT = Code("no-default", "controllers", WARNING, "an output has no default, and for some inputs no rule fires")
NOT_AT_REST = Code("not-at-rest", "controllers", WARNING, "an output is not zero at the neutral point of its input")
NOT_MONOTONE = Code("not-monotone", "controllers", WARNING, "an output changes direction although its input does not")
SURFACE_STEP = Code("surface-step", "controllers", WARNING, "an output jumps while its input hardly moves")


STEP_SHARE, TURN_SHARE, REST_SHARE = 0.1, 0.02, 0.02
"""Shares of an output's range: the least step and reversal to report, and the greatest value that counts as 0."""

MIN_RANGE_SHARE = 0.2
"""The least share of the declared range that an output should use."""

RESOLUTION_FACTOR = 4
"""The factor by which the resolution is raised to estimate the error of the original resolution."""

CORNERS = 5, 400
"""The maximum number of points in each input's range, and of their combinations."""


class SurfaceSamples(NamedTuple):
    """The samples of a controller's surface."""

    slices: list[Slice]
    """Each output over each input, with the other inputs neutral."""
    steps: list[tuple[Slice, SurfaceJump]]
    """The slices with a jump of more than STEP_SHARE, and the jump."""
    neutral_inputs: dict[str, float]
    """The outputs by name if all inputs are neutral."""
    reach: dict[str, tuple[float, float]]
    """The minimum and the maximum of each output."""
    silent: dict[str, dict[str, float]]
    """For each output that is undefined for some inputs, the first such inputs."""
    off: dict[str, float]
    """For each output with an `accuracy`, the maximum difference from its value at a finer resolution."""


def sample_surface(controller: ControllerDefinition) -> SurfaceSamples:
    """Sample a controller's outputs over each input, over combinations of input values, and at rest."""
    survey = Survey(controller)
    slices = list(survey.slices())
    smooth = [
        s
        for s in slices
        if controller.outputs[s.output].defuzzifier in ("centroid", "bisector", *WEIGHTED_DEFUZZIFIERS)
    ]
    steps = [(s, step) for s in smooth if (step := survey.step(s, STEP_SHARE))]
    corners = [(point, survey.at(point)) for point in _corners(controller)]
    reach, silent = {}, {}
    for name in controller.outputs:
        said = [y for s in slices if s.output == name for y in s.ys] + [outputs[name] for _, outputs in corners]
        sound = [y for y in said if not isnan(y)]
        reach[name] = (min(sound, default=0.0), max(sound, default=0.0))
        found = next(
            (point for point, outputs in _all(slices, corners, survey.neutral_inputs, name) if isnan(outputs)), None
        )
        if found is not None:
            silent[name] = found
    return SurfaceSamples(slices, steps, survey.at({}), reach, silent, _off(controller, slices))


def _corners(controller: ControllerDefinition) -> Iterator[dict[str, float]]:
    """Yield combinations of values of the bounded inputs, if any output depends on several inputs.

    Unbounded inputs are left out. CORNERS are the maximum number of evenly spread values of each input, and of the
    combinations: many inputs have fewer values each. If even two values each are too many, nothing is yielded.
    """
    names = [n for n, v in controller.inputs.items() if abs(v.minimum) < 1e300 and abs(v.maximum) < 1e300]
    points, most = CORNERS
    while len(names) > 1 and points > 1 and points ** len(names) > most:
        points -= 1
    together = any(len(asked(controller, output)) > 1 for output in controller.outputs)
    if together and points > 1 and points ** len(names) <= most:
        for values in product(*(grid(controller.inputs[name], points) for name in names)):
            yield dict(zip(names, values, strict=True))


def _all(
    slices: list[Slice],
    corners: list[tuple[dict[str, float], dict[str, float]]],
    neutral_inputs: dict[str, float],
    name: str,
) -> Iterator[tuple[dict[str, float], float]]:
    for s in slices:
        if s.output == name:
            yield from (({**neutral_inputs, s.input: x}, y) for x, y in zip(s.xs, s.ys, strict=True))
    yield from ((point, outputs[name]) for point, outputs in corners)


def _off(controller: ControllerDefinition, slices: list[Slice]) -> dict[str, float]:
    """Return the maximum error of each output with an `accuracy`.

    The error is the difference from the value with RESOLUTION_FACTOR times the resolution.
    """
    exact = {
        n: v for n, v in controller.outputs.items() if v.accuracy is not None and v.defuzzifier in INTEGRAL_DEFUZZIFIERS
    }
    if not exact:
        return {}
    most = max(v.resolution for v in exact.values())
    survey, finer = Survey(controller, most), Survey(_finer(controller), RESOLUTION_FACTOR * most)
    found: dict[str, float] = {}
    for s in slices:
        if s.output in exact:
            for x in s.xs[::4]:
                off = abs(survey.at({s.input: x})[s.output] - finer.at({s.input: x})[s.output])
                found[s.output] = max(found.get(s.output, 0.0), 0.0 if isnan(off) else off)
    return found


def _finer(controller: ControllerDefinition) -> ControllerDefinition:
    from dataclasses import replace

    outputs = {n: replace(v, resolution=RESOLUTION_FACTOR * v.resolution) for n, v in controller.outputs.items()}
    return replace(controller, outputs=outputs)


def check(controller: ControllerDefinition, report: DocumentReport, seen: SurfaceSamples) -> None:
    """Report undefined values, steps, reversals, values other than 0 at rest, and unfit ranges and resolutions."""
    for variable in controller.outputs.values():
        _silence(controller, variable, report, seen)
        _reached(controller, variable, report, seen)
        _coarse(variable, report, seen)
    for found, step in seen.steps:
        where = controller.outputs[found.output].where
        low, high = round(step.low, 9) + 0.0, round(step.high, 9) + 0.0  # -0.0 becomes 0.0
        message = f"`{found.output}` jumps from {low:.3g} to {high:.3g} when `{found.input}` passes {step.x:.4g}"
        report(SURFACE_STEP, where, message, "make neighbouring terms overlap, and avoid vertical edges", key=True)
    for found in seen.slices:
        if controller.inputs[found.input].neutral is not None:
            _turns(controller, found, report)
            _rests(controller, found, report, seen)


def _silence(
    controller: ControllerDefinition, variable: Variable, report: DocumentReport, seen: SurfaceSamples
) -> None:
    point = seen.silent.get(variable.name)
    if point is not None and variable.default is None:
        where = ", ".join(f"{name} = {x:.4g}" for name, x in point.items() if name in asked(controller, variable.name))
        lack = "it has no earlier value to keep" if variable.lock_previous else "it has no default"
        message = f"`{variable.name}` has no value at {where}: no rule fires, and {lack}"
        report(NO_DEFAULT, variable.where, message, "write `default: 0`, or add rules for this case", key=True)


def _reached(
    controller: ControllerDefinition, variable: Variable, report: DocumentReport, seen: SurfaceSamples
) -> None:
    concluded = {c.term for rule in controller.rules for c in rule.consequents if c.variable == variable.name}
    low, high = seen.reach[variable.name]
    width = variable.maximum - variable.minimum
    over = max(high - variable.maximum, variable.minimum - low)
    where = (*variable.where, "range")
    if over > 1e-6 * width and not variable.lock_range:
        message = f"`{variable.name}` goes from {low:.4g} to {high:.4g}, beyond its range"
        report(ATTAINABLE_RANGE, where, message, f"write [{low:.4g}, {high:.4g}], or `lock-range: true`")
    elif 1e-9 * width < high - low < MIN_RANGE_SHARE * width and len(concluded) > 1:
        message = f"`{variable.name}` only goes from {low:.4g} to {high:.4g}, a small part of its range"
        report(ATTAINABLE_RANGE, where, message, "move its terms outwards, or narrow the range")


def _coarse(variable: Variable, report: DocumentReport, seen: SurfaceSamples) -> None:
    off = seen.off.get(variable.name, 0.0)
    if variable.accuracy is not None and off > variable.accuracy:
        message = (
            f"with {variable.resolution:,} points, `{variable.name}` is off by {off:.2g}, but its `accuracy` is"
            f" {variable.accuracy:g}"
        )
        hint = f"raise `resolution` to {RESOLUTION_FACTOR * variable.resolution:,}, or write a larger `accuracy`"
        report(COARSE_RESOLUTION, (*variable.where, "accuracy"), message, hint)


def _turns(controller: ControllerDefinition, found: Slice, report: DocumentReport) -> None:
    """Report an output that both rises and falls over an input."""
    output = controller.outputs[found.output]
    least = TURN_SHARE * (output.maximum - output.minimum)
    extremes = list(_extremes(found, least))
    if len(extremes) > 2:
        x, y = extremes[1]
        way, back = ("rises", "falls") if y > extremes[0][1] else ("falls", "rises")
        message = f"`{output.name}` {way} until `{found.input}` is {x:.4g}, and then {back}"
        hint = "check the order of the terms and the conclusions of the rules"
        report(NOT_MONOTONE, output.where, message, hint, key=True)


def _extremes(found: Slice, least: float) -> Iterator[tuple[float, float]]:
    """Yield the two ends of a curve and the points at which it reverses by more than `least`."""
    points = [(x, y) for x, y in zip(found.xs, found.ys, strict=True) if not isnan(y)]
    if not points:
        return
    yield points[0]
    low = high = points[0]
    way = 0
    for point in points:
        low, high = min(low, point, key=itemgetter(1)), max(high, point, key=itemgetter(1))
        if way >= 0 and high[1] - point[1] > least:
            if way > 0:
                yield high
            way, low, high = -1, point, point
        elif way <= 0 and point[1] - low[1] > least:
            if way < 0:
                yield low
            way, low, high = 1, point, point
    yield points[-1]


def _rests(controller: ControllerDefinition, found: Slice, report: DocumentReport, seen: SurfaceSamples) -> None:
    output, variable = controller.outputs[found.output], controller.inputs[found.input]
    value = seen.neutral_inputs[output.name]
    if abs(value) > REST_SHARE * (output.maximum - output.minimum) and output.minimum <= 0.0 <= output.maximum:
        message = (
            f"at rest, with `{variable.name}` at {variable.neutral:g}, `{output.name}` is {value:.3g} instead of 0"
        )
        hint = "change the rule for the middle term of the input: conclude the output term around 0"
        others = [(variable.where, "its neutral point")]
        report(NOT_AT_REST, output.where, message, hint, key=True, related=others)
