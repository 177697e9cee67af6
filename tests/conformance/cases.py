"""The cases of the SCION test framework, and their results in our importer and interpreter.

A case is a statechart in SCXML and, mostly, a driver: which states have to be active at first, and after each of some
events. `scripts/fetch.py` fetches them.
"""

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from lumen.features.formats_charts.scxml import read_scxml
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.yaml_reader import parse
from lumen.statechart import Event, Machine, Snapshot, Step, due, initial, step
from tests.fetched import fetched
from tests.scanning import matching

TABLE = Path(__file__).parent / "unsupported.yaml"


@dataclass(frozen=True)
class Case:
    """A case; `name` is for example `parallel/test1`, and `driver` is None if the case has no driver."""

    name: str
    chart: Path
    driver: Mapping[str, Any] | None

    @property
    def suite(self) -> str:
        """The origin of the test: `W3C` or `SCION`."""
        return "W3C" if self.name.startswith("w3c") else "SCION"

    def read(self) -> tuple[dict[str, Any] | None, list[Diagnostic]]:
        """Return the importer's result for the chart; it is shared, so do not change it."""
        return _read(self.chart)

    def complaints(self) -> list[str]:
        """Return the errors of importing the chart and the charts in other files that it invokes."""
        found = [d.message for d in self.read()[1] if d.severity is Severity.ERROR]
        for invoked in self.invoked().values():
            found += invoked.complaints()
        return found

    def invoked(self) -> "dict[str, Case]":
        """Return the charts in other files that it invokes, by the names of the behaviours that they become."""
        names = re.findall(r'<invoke [^>]*src="file:([^"]*)\.scxml"', self.chart.read_text("utf-8"))
        return {name: _case(chart) for name in names for chart in sorted(self.chart.parent.glob(f"{name}.*scxml"))}

    def behaviors(self) -> dict[str, dict[str, Any]]:
        """Return the imported behaviours that the chart invokes, by name."""
        return {name: data for name, case in self.invoked().items() if (data := case.read()[0])}


@cache
def _read(chart: Path) -> tuple[dict[str, Any] | None, list[Diagnostic]]:
    try:
        return read_scxml(chart.name, chart.read_bytes(), "chart")
    except ForeignFileError as error:
        return None, [error.diagnostic]


def machine_of(data: Mapping[str, Any]) -> Machine:
    """Return the machine; the behaviours that it invokes exist, and do nothing."""
    rows = list(_invokes(data))
    others: dict[str, dict[str, Any]] = {}
    for row in rows:
        keys = row.get("input", {})
        others[row["behavior"]] = {
            "context": dict.fromkeys(keys),
            "types": {key: {} for key in keys},
            "states": {"a": None},
        }
    return Machine.from_dict(dict(data), behaviors=others)


def _invokes(state: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    found = state.get("invoke") or []
    yield from found if isinstance(found, list) else [found]
    for child in (state.get("states") or {}).values():
        yield from _invokes(child or {})


@cache
def table() -> Mapping[str, Any]:
    """Return the table of the cases that do not pass, with the reasons."""
    document, diagnostics = parse(TABLE.name, TABLE.read_bytes())
    assert document is not None
    assert not diagnostics
    return document.data


def cases() -> list[Case]:
    """Return all cases; fetch them first if they are not there."""
    return [_case(path) for path in matching(fetched("scion") / "test", "*/*.scxml")]


ADJUSTED = {
    "legacy semantics": "its `legacySemantics` are expected, which agree with W3C's Appendix D; the others do not",
    "answered at once": "the first configuration is not compared: the invoked chart answers in the step that starts it",
}
"""Groups in the table of cases whose driver is adjusted, and how and why."""


class Outcome(NamedTuple):
    """The outcome of a case with a driver.

    `as_given` and `passed` are False if the importer leaves something out. `why` holds the reasons, empty if it passed.
    """

    case: Case
    as_given: bool
    """Whether all configurations agree with the driver as SCION gives it."""
    adjusted: str
    """The group of `ADJUSTED` that the case belongs to, or empty."""
    passed: bool
    """Whether all configurations agree, after the adjustment if there is one."""
    why: tuple[str, ...]


def run(case: Case, machine: Machine | None = None) -> Outcome:
    """Import, start and drive a case; `machine` is its compiled chart, if the caller has it."""
    assert case.driver is not None
    adjusted = next((group for group in ADJUSTED if case.name in table()[group]), "")
    if complaints := case.complaints():
        return Outcome(case, False, adjusted, False, tuple(dict.fromkeys(complaints)))
    data, _ = case.read()
    assert data is not None
    machine = machine or Machine.from_dict(data, behaviors=case.behaviors())
    given = list(play(machine, case.driver))
    pairs = list(play(machine, case.driver["legacySemantics"])) if adjusted == "legacy semantics" else given
    pairs = pairs[adjusted == "answered at once" :]
    wrong = tuple(f"expected {expected}, but {found} are active" for expected, found in pairs if expected != found)
    return Outcome(case, all(expected == found for expected, found in given), adjusted, not wrong, wrong)


def _case(chart: Path) -> Case:
    driver = chart.with_suffix(".json")
    name = f"{chart.parent.name}/{chart.name.removesuffix('.scxml').removesuffix('.txml')}"
    return Case(name, chart, json.loads(driver.read_bytes()) if driver.exists() else None)


def play(machine: Machine, driver: Mapping[str, Any]) -> Iterator[tuple[list[str], list[str]]]:
    """Yield the atomic states expected and those that are active: at first, and after each event, in virtual time."""
    now, steps = 0.0, [initial(machine)]
    yield sorted(driver["initialConfiguration"]), _atomic(machine, steps[-1].snapshot)
    for row in driver["events"]:
        now += row.get("after", 0) / 1000
        steps.extend(_elapsed(machine, steps, now))
        event = Event(row["event"]["name"], row["event"].get("data"), now)
        steps.append(step(machine, steps[-1].snapshot, event))
        yield sorted(row["nextConfiguration"]), _atomic(machine, steps[-1].snapshot)


def _elapsed(machine: Machine, steps: list[Step], now: float) -> Iterator[Step]:
    """Yield the steps of all timers that are due until `now` [s]."""
    snapshot = steps[-1].snapshot
    while (event := due(snapshot)) is not None and event.at <= now:
        taken = step(machine, snapshot, event)
        snapshot = taken.snapshot
        yield taken


def _atomic(machine: Machine, snapshot: Snapshot) -> list[str]:
    states = (s for s in machine.states.values() if s.path and not s.children)
    return sorted(s.name for s in states if s.name in snapshot.configuration)
