"""Build a `ControllerDefinition` from the plain data of a fuzzy controller, `fuzzy/NAME.yaml`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.controllers import ControllerDefinition, TrackingSettings
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.project.bindings import Bindings
from lumen.project.complaints import MISSING_KEY
from lumen.project.document import Document, NodeSpan
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import without_extremes
from lumen.project.rulebook import UNKNOWN_VARIABLE, Rulebook
from lumen.project.terms import TWO_SHAPES
from lumen.project.units import ANGLES, BAD_DURATION, seconds
from lumen.project.variables import build_variables


def spread(report: DocumentReport) -> Any:
    """Return the data with each cell of the table `terms:` moved to its variable; the report's document changes too.

    Findings about a moved cell still point at the table. A cell of an unknown variable, or of a term that the variable
    already has, is reported and left out.
    """
    document = report.document
    if not document.data.get("terms"):
        return document.data
    table = _Table(report)
    for kind, rows in document.data["terms"].items():
        for term, row in rows.items():
            for name, parameters in row.items():
                table.cell(kind, term, name, parameters)
    report.document = Document(document.file, table.data, table.places, document.text)
    return table.data


class _Table:
    """Copies of the data and its places, into which cells are moved."""

    def __init__(self, report: DocumentReport) -> None:
        data = report.document.data
        self.report = report
        self.sides = {
            side: {name: {**spec, "terms": dict(spec.get("terms") or {})} for name, spec in data[side].items()}
            for side in ("inputs", "outputs")
        }
        self.data = {**data, **self.sides}
        self.places: dict[NodePath, NodeSpan] = dict(report.document.spans)

    def cell(self, kind: str, term: str, name: str, parameters: Any) -> None:
        path: NodePath = ("terms", kind, term, name)
        side = next((side for side, variables in self.sides.items() if name in variables), "")
        if not side:
            names = [name for variables in self.sides.values() for name in variables]
            hint = did_you_mean(name, names, "the variables are")
            message, cause = f"there is no variable `{name}`", f"{self.report.document.file} unknown-variable {name}"
            self.report(UNKNOWN_VARIABLE, path, message, hint=hint, key=True, cause=cause)
            self.report.lost.add(term)  # the intended variable now lacks a term of that name
            return
        if term in self.sides[side][name]["terms"]:
            message = f"`{name}` already has a term `{term}`: a term can have only one shape"
            self.report(TWO_SHAPES, path, message, hint="delete one of them", key=True)
            return
        self.sides[side][name]["terms"][term] = {kind: parameters}
        self.moved(path, (side, name, "terms", term), kind)

    def moved(self, path: NodePath, to: NodePath, kind: str) -> None:
        """Add the places of the cell and its numbers under the new path."""
        if any(lost[: len(path)] == path for lost in self.report.pruned):
            self.report.pruned.add((*to, kind))
        found = self.report.document.spans.get(path)
        if found is None:
            return
        self.places[to] = self.places[(*to, kind)] = found
        for inner in (p for p in self.report.document.spans if p[: len(path)] == path and len(p) > len(path)):
            self.places[(*to, kind, *inner[len(path) :])] = self.report.document.spans[inner]


def termless(data: Mapping[str, Any], report: DocumentReport) -> None:
    """Report outputs without a term."""
    for name, spec in data["outputs"].items():
        path: NodePath = ("outputs", name)
        if not (spec.get("terms") or report.broken(path) or report.broken(("terms",))):
            message = f"the output `{name}` has no terms"
            hint = "add `terms:` to it, or a table `terms:` for all variables"
            report(MISSING_KEY, path, message, hint=hint, key=True)


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
