"""The parameter table of a controller: `terms:` by shape, term and variable, as the paper prints it."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.project.complaints import MISSING_KEY
from lumen.project.document import Document, NodeSpan
from lumen.project.document_report import DocumentReport
from lumen.project.rulebook import UNKNOWN_VARIABLE
from lumen.project.terms import TWO_SHAPES


def spread(report: DocumentReport) -> Any:
    """Return the data with each cell of the table moved to its variable; its place in the file stays the same.

    A cell without a variable, and one of a term that the variable already has, is reported.
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
