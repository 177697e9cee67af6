"""One evaluation as a sheet: what the inputs belong to, how much each rule fires, and the sets that come of it."""

from lumen.formats.plots.controllers import axis, memberships
from lumen.formats.plots.sheet import Axis, Bars, Line, Mark, Panel, Sheet
from lumen.interpreters.inference.explanation import Concluded, Explanation
from lumen.language.controllers import ControllerDefinition, Variable

LONGEST = 60
"""Characters of a rule beside its bar."""


def explained_sheet(controller: ControllerDefinition, said: Explanation) -> Sheet:
    """Memberships with the inputs marked; the rules; each output's set with its value, or where nothing fired, that."""
    panels = [
        memberships(variable, (Mark(said.inputs[name], f"{said.inputs[name]:g}", strong=True),))
        for name, variable in controller.inputs.items()
    ]
    texts = tuple(_short(rule.text) for rule, _ in said.rules)
    bars = Bars(texts, tuple(degree for _, degree in said.rules))
    panels.append(Panel("How much each rule fires", Axis("degree", 0.0, 1.0), Axis(""), bars=bars))
    panels += [_concluded(controller.outputs[name], found) for name, found in said.outputs.items()]
    given = ", ".join(f"{name} = {value:g}" for name, value in said.inputs.items())
    return Sheet(f"Controller {controller.name} at {given}", tuple(panels), min(3, len(panels)))


def _concluded(variable: Variable, found: Concluded) -> Panel:
    value = f"{found.value:.3f} {variable.unit}".strip()
    title = f"{variable.name} = {value}" + ("" if found.fired else ": no rule fires")
    marks = (Mark(found.value, value, strong=True),)
    if found.points:
        line = Line(found.points, found.memberships, "aggregated", filled=True)
        return Panel(title, axis(variable), Axis("membership", 0.0, 1.05), (line,), marks)
    bars = Bars(tuple(found.degrees), tuple(found.degrees.values()))
    return Panel(title, Axis("degree", 0.0, 1.0), Axis(""), bars=bars)


def _short(text: str) -> str:
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
