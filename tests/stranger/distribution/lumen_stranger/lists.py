"""Lists of states (`*.states`): a line for each state, which leads to the next one at the event behind it."""

from typing import Any

from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.machines import MachineDefinition
from lumen.project.formats.conversion_findings import ConversionFindings, PlaceOfPath
from lumen.project.formats.known import FormatTable, Known

KNOWN: FormatTable = {"line": Known(frozenset(("state", "event")), lost={"comment": "comments are left out"})}


def read_states(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    findings = ConversionFindings()
    rows = []
    for number, line in enumerate(content.decode().splitlines(), 1):
        if line.startswith("#"):
            findings.lost(Place(file, number, 1, number, len(line) + 1), "a comment is left out")
        else:
            rows.append(line.split())
    states = {row[0]: {"on": {row[1]: after[0]}} for row, after in zip(rows, [*rows[1:], rows[0]], strict=True)}
    return {"id": title, "initial": rows[0][0], "states": states}, findings.diagnostics


def write_states(machine: MachineDefinition, place: PlaceOfPath) -> tuple[str, list[Diagnostic]]:
    return "".join(f"{name}\n" for name in machine.states if name), []
