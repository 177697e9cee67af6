"""W3C's and SCION's cases of SCXML through our importer and our interpreter; `unsupported.yaml` has the others."""

import json
from collections.abc import Mapping

import pytest

from lumen.formats.conversion_findings import dotted
from lumen.formats.scxml import read_scxml, write_scxml
from lumen.formats.xstate import read_xstate, write_xstate
from lumen.statechart import Machine
from tests.conformance.cases import Case, cases, machine_of, play, table

CASES = cases()
TABLE = table()
REASONS: Mapping[str, str] = {name: reason for reason, names in TABLE["unsupported"].items() for name in names}
PASSING = [c for c in CASES if c.driver is not None and c.name not in REASONS]


def test_the_cases_are_there() -> None:
    assert len(CASES) == 335
    assert {c.name for c in CASES if c.driver is None} == set(TABLE["without a driver"])
    assert set(REASONS) <= {c.name for c in CASES if c.driver is not None}
    assert len(PASSING) >= 180


@pytest.mark.parametrize("case", PASSING, ids=lambda case: case.name)
def test_a_case_passes(case: Case) -> None:
    data, diagnostics = case.read()
    assert case.complaints() == []
    assert data is not None
    assert case.driver is not None
    driver = case.driver["legacySemantics"] if case.name in TABLE["legacy semantics"] else case.driver
    pairs = list(play(Machine.from_dict(data, behaviors=case.behaviors()), driver))
    for expected, found in pairs[case.name in TABLE["answered at once"] :]:
        assert found == expected, diagnostics


@pytest.mark.parametrize("case", [c for c in CASES if c.name in REASONS], ids=lambda case: case.name)
def test_what_is_unsupported_still_is(case: Case) -> None:
    """The importer says why; once it no longer does, the case belongs to those that pass."""
    reason = REASONS[case.name]
    assert any(reason in complaint for complaint in case.complaints())


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_import_export_import_is_a_fixed_point(case: Case) -> None:
    data, _ = case.read()
    assert data is not None
    machine = machine_of(data)
    text, written = write_scxml(machine, dotted(case.name))
    again, read = read_scxml(case.name, text.encode(), "chart")
    assert json.dumps(again) == json.dumps(data)
    assert [d.message for d in [*written, *read] if "invoke" not in d.message] == []
    once, _ = read_xstate(case.name, write_xstate(machine, dotted(case.name))[0].encode(), "chart")
    twice, _ = read_xstate(case.name, write_xstate(machine_of(once), dotted(case.name))[0].encode(), "chart")
    assert json.dumps(twice) == json.dumps(once)


@pytest.mark.parametrize("case", PASSING, ids=lambda case: case.name)
def test_xstate_carries_a_case_and_changes_nothing(case: Case) -> None:
    data, _ = case.read()
    assert data is not None
    assert case.driver is not None
    machine = Machine.from_dict(data, behaviors=case.behaviors())
    text, _ = write_xstate(machine, dotted(case.name))
    carried = read_xstate(case.name, text.encode(), "chart")[0]
    back = Machine.from_dict(carried, behaviors=case.behaviors())

    assert list(play(back, case.driver)) == list(play(machine, case.driver))
