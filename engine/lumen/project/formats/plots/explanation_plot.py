"""Plot one evaluation: the memberships of the inputs, the degree of each rule, and the resulting fuzzy sets."""

from lumen.fuzzy.explanation import Concluded, Explanation
from lumen.language.controllers import ControllerDefinition, Variable
from lumen.project.formats.plots.controller_plot import axis, memberships
from lumen.project.formats.plots.sheet import PlotAxis, PlotBars, PlotLine, PlotMark, PlotPanel, PlotSheet

MAX_RULE_LENGTH = 60
"""The maximum number of characters of a rule next to its bar."""


def explained_sheet(controller: ControllerDefinition, said: Explanation) -> PlotSheet:
    """Return a sheet with the inputs marked in their memberships, the rules, and each output's set with its value.

    The title of an output says if no rule fires for it.
    """
    panels = [
        memberships(variable, (PlotMark(said.inputs[name], f"{said.inputs[name]:g}", strong=True),))
        for name, variable in controller.inputs.items()
    ]
    texts = tuple(_short(rule.text) for rule, _ in said.rules)
    bars = PlotBars(texts, tuple(degree for _, degree in said.rules))
    panels.append(PlotPanel("Degree of each rule", PlotAxis("degree", 0.0, 1.0), PlotAxis(""), bars=bars))
    panels += [_concluded(controller.outputs[name], found) for name, found in said.outputs.items()]
    given = ", ".join(f"{name} = {value:g}" for name, value in said.inputs.items())
    return PlotSheet(f"Controller {controller.name} at {given}", tuple(panels), min(3, len(panels)))


def _concluded(variable: Variable, found: Concluded) -> PlotPanel:
    value = f"{found.value:.3f} {variable.unit}".strip()
    title = f"{variable.name} = {value}" + ("" if found.fired else ": no rule fires")
    marks = (PlotMark(found.value, value, strong=True),)
    if found.points:
        line = PlotLine(found.points, found.memberships, "aggregated", filled=True)
        return PlotPanel(title, axis(variable), PlotAxis("membership", 0.0, 1.05), (line,), marks)
    bars = PlotBars(tuple(found.degrees), tuple(found.degrees.values()))
    return PlotPanel(title, PlotAxis("degree", 0.0, 1.0), PlotAxis(""), bars=bars)


def _short(text: str) -> str:
    return text if len(text) <= MAX_RULE_LENGTH else text[: MAX_RULE_LENGTH - 1] + "…"
