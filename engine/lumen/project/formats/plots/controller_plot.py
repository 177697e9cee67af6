"""Plot a controller: the membership functions of all variables, then each output over its inputs."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain
from math import isfinite, isnan

from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.survey import Survey, asked, resting
from lumen.language.controllers import VALUE_TERMS, ControllerDefinition, Variable
from lumen.project.formats.plots.sheet import PlotAxis, PlotLine, PlotMark, PlotPanel, PlotSheet, PlotSurface

POINTS, ACROSS = 321, 41
"""The number of points of a curve, and along each side of a surface."""

CURVE_RESOLUTION = 1000
"""The number of steps for the integration of an output's fuzzy set."""


def controller_sheet(controller: ControllerDefinition) -> PlotSheet:
    """Return a sheet with the membership functions of each variable, then each output over its inputs.

    An output of one input is a curve, one of two inputs a surface. With more inputs there is one curve for each, while
    the others have their resting values.
    """
    survey = Survey(controller, CURVE_RESOLUTION)
    panels = [memberships(variable) for variable in variables(controller)]
    answers = list(chain.from_iterable(_answers(survey, output) for output in controller.outputs.values()))
    gaps = any(isnan(y) for panel in answers for line in panel.lines for y in line.ys)
    note = "Gaps in a line: no rule fires, so the default or the previous value is used." if gaps else ""
    count = len(panels) + len(answers)
    return PlotSheet(f"Controller {controller.name}", (*panels, *answers), min(count, 3 if count <= 9 else 4), note)


def curves_sheet(title: str, controllers: Mapping[str, ControllerDefinition]) -> PlotSheet:
    """Return a sheet with the outputs of several versions of a controller, given by label, in the same panels.

    The first version decides which inputs and outputs are drawn. Raises StopIteration if there is no version.
    """
    first = next(iter(controllers.values()))
    panels = []
    for output in first.outputs.values():
        for name in sorted(asked(first, output.name), key=list(first.inputs).index):
            lines = [
                PlotLine(*_curve(Survey(controller, CURVE_RESOLUTION), output, name), label, style)
                for style, (label, controller) in enumerate(controllers.items())
            ]
            marks = (*_neutral(first.inputs[name]), PlotMark(0.0, level=True))
            height = PlotAxis(_label(replace(output, direction="")))  # the versions may differ in it
            panels.append(PlotPanel("", axis(first.inputs[name]), height, tuple(lines), marks))
    return PlotSheet(title, tuple(panels), len(panels))


def variables(controller: ControllerDefinition) -> Iterator[Variable]:
    """Yield the inputs, then the outputs."""
    yield from controller.inputs.values()
    yield from controller.outputs.values()


def memberships(variable: Variable, marks: tuple[PlotMark, ...] = ()) -> PlotPanel:
    """Return a panel of a variable's terms over its range. Constants are upright lines; formulas are left out."""
    low, high = ends(variable)
    xs = tuple(low + (high - low) * i / (POINTS - 1) for i in range(POINTS))
    lines = []
    for style, term in enumerate(variable.terms.values()):
        if term.kind == "constant":
            lines.append(PlotLine((term.parameters[0],) * 2, (0.0, term.height), term.name, style))
        elif term.kind not in VALUE_TERMS and not (term.kind == "function" and variable.weighted):
            shape = membership(NUMBERS, term)
            lines.append(PlotLine(xs, tuple(float(shape(x)) for x in xs), term.name, style))
    title = variable.name
    return PlotPanel(
        title, axis(variable), PlotAxis("membership", 0.0, 1.05), tuple(lines), (*_neutral(variable), *marks)
    )


def axis(variable: Variable) -> PlotAxis:
    """Return an axis with the variable's name, unit and direction, over its range."""
    return PlotAxis(_label(variable), *ends(variable))


def ends(variable: Variable) -> tuple[float, float]:
    """Return the ends of a variable's range; an infinite end is replaced so that all terms of the variable fit."""
    if isfinite(variable.minimum) and isfinite(variable.maximum):
        return variable.minimum, variable.maximum
    said = [p for term in variable.terms.values() for p in term.parameters if isfinite(p)] or [-1.0, 1.0]
    low = variable.minimum if isfinite(variable.minimum) else min(said) - 1.0
    high = variable.maximum if isfinite(variable.maximum) else max(said) + 1.0
    return low, max(high, low + 1.0)


def _answers(survey: Survey, output: Variable) -> Iterator[PlotPanel]:
    controller = survey.controller
    names = [name for name in controller.inputs if name in asked(controller, output.name)]
    if len(names) == 2:
        yield _surface(survey, output, controller.inputs[names[0]], controller.inputs[names[1]])
        return
    for name in names:
        others = ", ".join(f"{other} = {resting(controller.inputs[other]):g}" for other in names if other != name)
        line = PlotLine(*_curve(survey, output, name))
        marks = (*_neutral(controller.inputs[name]), PlotMark(0.0, level=True))
        title = f"{output.name} at {others}" if others else f"{output.name} by {name}"
        yield PlotPanel(title, axis(controller.inputs[name]), _height(output), (line,), marks)


def _surface(survey: Survey, output: Variable, across: Variable, up: Variable) -> PlotPanel:
    xs, ys = (_finite_grid(variable) for variable in (across, up))
    zs = tuple(tuple(survey.at({across.name: x, up.name: y})[output.name] for x in xs) for y in ys)
    marks = (*_neutral(across), *(PlotMark(mark.at, mark.label, level=True) for mark in _neutral(up)))
    title = f"{output.name} by {across.name} and {up.name}"
    return PlotPanel(title, axis(across), axis(up), marks=marks, surface=PlotSurface(xs, ys, zs, _label(output)))


def _finite_grid(variable: Variable) -> tuple[float, ...]:
    low, high = ends(variable)
    return tuple(low + (high - low) * i / (ACROSS - 1) for i in range(ACROSS))


def _curve(survey: Survey, output: Variable, name: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    variable = survey.controller.inputs[name]
    low, high = ends(variable)
    xs = tuple(low + (high - low) * i / (POINTS - 1) for i in range(POINTS))
    return xs, tuple(survey.at({name: x})[output.name] for x in xs)


def _height(output: Variable) -> PlotAxis:
    """Return the vertical axis of an output, scaled to its curve: an output may use only a part of its range."""
    return PlotAxis(_label(output))


def _neutral(variable: Variable) -> tuple[PlotMark, ...]:
    return () if variable.neutral is None else (PlotMark(variable.neutral, "neutral"),)


def _label(variable: Variable) -> str:
    unit = f" [{variable.unit}]" if variable.unit else ""
    return f"{variable.name}{unit}" + (f", to the {variable.direction}" if variable.direction in _SIDES else
                                       f", {variable.direction}" if variable.direction else "")  # fmt: skip


_SIDES = ("left", "right")
