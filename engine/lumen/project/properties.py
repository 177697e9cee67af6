"""Read `properties` of a behaviour or a story from their plain data."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.expressions import check_expression
from lumen.expressions.own_functions import KnownFunctions, expanded
from lumen.language.actions import Expression
from lumen.language.diagnostics import NodePath
from lumen.language.properties import Property
from lumen.project.complaints import ONE_VERB
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import expanded_here, place_within
from lumen.project.routes import duration

ReadCondition = Callable[[str, NodePath], Expression | None]


def build_properties(data: Mapping[str, Any], report: DocumentReport, read: ReadCondition) -> tuple[Property, ...]:
    """Return the properties that can be read, in the order of the file; report the others."""
    found = []
    for name, row in (data.get("properties") or {}).items():
        where = ("properties", name)
        said = [key for key in ("always", "eventually") if key in row]
        if not said and report.broken(where):
            continue
        if len(said) != 1:
            hint = "write `always:` and a condition, or `eventually:` and `within:`; to use both, add another property"
            report(ONE_VERB, where, f"`{name}` needs exactly one condition: `always` or `eventually`", hint, key=True)
            continue
        conditions = {key: read(row[key], (*where, key)) for key in ("always", "eventually", "whenever") if key in row}
        within = duration(row, "within", report, where) if "within" in row else 0.0
        if None not in conditions.values() and within is not None:
            found.append(Property(name, **conditions, within=within, where=where))
    return tuple(found)


def unbound_conditions(report: DocumentReport, functions: KnownFunctions) -> ReadCondition:
    """Return a reader of conditions for a file that does not declare the names in them."""

    def read(source: str, where: NodePath) -> Expression | None:
        findings = check_expression(source, context=None, functions=functions)
        for finding in findings:
            place = place_within(report.document, where, source, finding.offset, finding.length)
            report.diagnostics.append(finding.code.at(place, finding.message, finding.hint))
        meant = None if findings else expanded_here(expanded, source, functions, report, where)
        return None if meant is None else Expression(meant, where, source if meant != source else "")

    return read
