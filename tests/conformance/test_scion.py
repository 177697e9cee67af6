"""W3C's and SCION's cases of SCXML through our importer and our interpreter; `unsupported.yaml` has the others."""

import json
from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial

import pytest

from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.xstate import read_xstate, write_xstate
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Machine
from tests import ROOT
from tests.conformance.__main__ import report
from tests.conformance.cases import Case, cases, machine_of, play, run, table
from tests.tables import check

CASES = cases()
TABLE = table()
REASONS: Mapping[str, str] = {name: reason for reason, names in TABLE["unsupported"].items() for name in names}
FOLDERS = sorted({c.name.partition("/")[0] for c in CASES})
PAGE = ROOT / "docs/formats.md"
PASSING = [c for c in CASES if c.driver is not None and c.name not in REASONS]


def test_the_cases_are_there() -> None:
    assert len(CASES) == 335
    assert {c.name for c in CASES if c.driver is None} == set(TABLE["without a driver"])
    assert set(REASONS) <= {c.name for c in CASES if c.driver is not None}
    assert len(PASSING) >= 180


def test_the_command_lists_each_failing_case_and_the_page_shows_its_counts() -> None:
    outcomes = [run(case) for case in CASES if case.driver is not None]
    lines = list(report(outcomes, len(CASES) - len(outcomes)))
    listed = [name for line in lines if line.startswith("      ") for name in line.strip().split(", ")]
    assert sorted(listed) == sorted(REASONS)
    page = PAGE.read_text("utf-8")
    for suite, *counts in (line.split() for line in lines[1:4]):
        assert f"| {suite} | {' | '.join(counts)} |" in page


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_case_passes_or_is_unsupported_and_every_format_carries_it(folder: str) -> None:
    """Each case is read and compiled once, then judged in each way that applies to it."""
    check(way for case in CASES if case.name.startswith(f"{folder}/") for way in ways(case))


def ways(case: Case) -> Iterator[tuple[str, Callable[[], None]]]:
    machine = cache(lambda: Machine.from_dict(case.read()[0], behaviors=case.behaviors()))
    if case.driver is not None and case.name not in REASONS:
        yield f"{case.name}: driver", partial(it_passes, case, machine)
        yield f"{case.name}: XState", partial(xstate_changes_nothing, case, machine)
    if case.name in REASONS:
        yield f"{case.name}: unsupported", partial(it_is_unsupported_still, case)
    yield f"{case.name}: fixed point", partial(import_export_import_is_a_fixed_point, case)


def it_passes(case: Case, machine: Callable[[], Machine]) -> None:
    outcome = run(case, machine())
    assert outcome.passed, (*outcome.why, *case.read()[1])
    assert outcome.as_given is not bool(outcome.adjusted), "adjust a driver only if the case fails with it as given"


def xstate_changes_nothing(case: Case, machine: Callable[[], Machine]) -> None:
    assert case.driver is not None
    text, _ = write_xstate(machine(), dotted(case.name))
    carried = read_xstate(case.name, text.encode(), "chart")[0]
    back = Machine.from_dict(carried, behaviors=case.behaviors())

    assert list(play(back, case.driver)) == list(play(machine(), case.driver))


def it_is_unsupported_still(case: Case) -> None:
    """The importer reports the reason; once it no longer does, the case belongs to those that pass."""
    reason = REASONS[case.name]
    assert any(reason in complaint for complaint in case.complaints())


def import_export_import_is_a_fixed_point(case: Case) -> None:
    data, _ = case.read()
    assert data is not None
    machine = machine_of(data)
    text, written = write_scxml(machine, dotted(case.name))
    again, found = read_scxml(case.name, text.encode(), "chart")
    assert json.dumps(again) == json.dumps(data)
    assert [d.message for d in [*written, *found] if "invoke" not in d.message] == []
    once, _ = read_xstate(case.name, write_xstate(machine, dotted(case.name))[0].encode(), "chart")
    twice, _ = read_xstate(case.name, write_xstate(machine_of(once), dotted(case.name))[0].encode(), "chart")
    assert json.dumps(twice) == json.dumps(once)
