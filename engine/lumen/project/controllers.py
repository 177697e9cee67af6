"""Build a `ControllerDefinition` from the plain data of a fuzzy controller, `fuzzy/NAME.yaml`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.controllers import ControllerDefinition, TrackingSettings
from lumen.language.diagnostics import NodePath
from lumen.project.bindings import Bindings
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import without_extremes
from lumen.project.rulebook import Rulebook
from lumen.project.table import spread, termless
from lumen.project.units import ANGLES, BAD_DURATION, seconds
from lumen.project.variables import build_variables


def build_controller(data: Any, report: DocumentReport, *, name: str) -> ControllerDefinition | None:
    """Return the controller that the data of `fuzzy/NAME.yaml` describes; None if it has no inputs or no outputs."""
    if not isinstance(data, Mapping) or not data.get("inputs") or not data.get("outputs"):
        return None
    without_extremes(data, report, _endless)
    data = spread(report)
    termless(data, report)
    angle = ANGLES.get((data.get("units") or {}).get("angle", "rad"), 1.0)
    inputs, outputs = build_variables(data, report, "inputs"), build_variables(data, report, "outputs")
    blocks = Rulebook(data, report, inputs, outputs).blocks()
    bindings = Bindings(data, report, outputs, angle)
    return ControllerDefinition(
        name=name,
        inputs=inputs,
        outputs=outputs,
        blocks=tuple(blocks),
        input_bindings=tuple(bindings.inputs()),
        output_bindings=tuple(bindings.outputs()),
        tracking=_tracking(data.get("track") or {}, report, angle),
        angle=angle,
        context_inputs=tuple(bindings.context_inputs()),
        signals=tuple(bindings.signals()),
    )


def _endless(path: NodePath) -> bool:
    """Return True if a number at this path may be infinite: ranges and terms have rules of their own."""
    return "terms" in path or "range" in path


def _tracking(data: Mapping[str, Any], report: DocumentReport, angle: float) -> TrackingSettings:
    """Return the settings under `track`, with times in [s] and angles in [rad]; keys that are absent have defaults."""
    said: dict[str, Any] = {key: data[key] for key in ("speed", "looks", "zoom") if key in data}
    times = {key: seconds(data.get(key)) for key in ("hold", "search", "period", "stale", "every")}
    for key in ("period", "stale"):
        if times[key] == 0:
            message = f"`{key}` must be longer than 0"
            report(BAD_DURATION, ("track", key), message, hint="write a longer time, or delete the key")
    said.update({key: time for key, time in times.items() if time is not None})
    for key in ("sweep", "ahead"):
        said[key] = {joint: float(value) * angle for joint, value in (data.get(key) or {}).items()}
    return TrackingSettings(**said)
