"""Visits that were recorded, played again with other files."""

from copy import deepcopy
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings

from lumen.errors import LumenError
from lumen.insight.replay.against import ENDS, MORE_STEPS, MOST_TIMES, SAME, SAYS, played_against
from lumen.insight.replay.entries import JournalJump
from lumen.insight.replay.visits import DROPPED, RecordedVisit, visits, waiting_state
from lumen.language.machines import MachineDefinition
from lumen.statechart import Machine
from tests.journal.making import Recorded, bundle
from tests.journal.test_replaying import PATIENT, quiet
from tests.reload.editing import Happenings
from tests.statechart.oracle.generating import Data, happenings, machine_data

__all__ = ["quiet"]

GUIDE: Data = {
    "id": "guide",
    "states": {
        "idle": {"on": {"face": "greet"}},
        "greet": {"do": [{"say": "Hello"}, {"say": "Welcome"}], "onDone": "listen", "after": {"20s": "idle"}},
        "listen": {
            "on": {"heard": [{"guard": "event.data.result == 'bye'", "target": "bye"}]},
            "after": {"30s": "idle"},
        },
        "bye": {"do": [{"say": "Goodbye"}], "onDone": "idle"},
    },
}
VISIT: Happenings = [("face", None), ("done.command.d1", None), ("done.command.d2", None), ("heard", {"result": "bye"})]


def recorded(machine: MachineDefinition, events: Happenings, folder: Path, times: int = 1) -> Recorded:
    found = Recorded(folder)
    found.begin(machine)
    for _ in range(times):
        for number, event in enumerate(events):
            found.happen(event, number)
    found.end()
    return found


def of(run: Recorded) -> list[RecordedVisit]:
    return list(visits((entry, next(iter(run.bundles.values())).machine) for entry in run.entries()))


def edited(*path: str, value: Any) -> Machine:
    data = deepcopy(GUIDE)
    place: Any = data["states"]
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return Machine.from_dict(data)


@pytest.fixture
def visit(tmp_path: Path) -> RecordedVisit:
    (found,) = of(recorded(Machine.from_dict(GUIDE), [*VISIT, ("done.command.d3", None)], tmp_path))
    return found


def test_a_visit_is_from_leaving_home_until_back(visit: RecordedVisit) -> None:
    assert waiting_state(Machine.from_dict(GUIDE)) == "idle"
    assert visit.whole
    assert visit.inputs[0].event.name == "face"
    assert visit.inputs[-1].entered == ("idle",)


RENAMED = {("hears" if name == "listen" else name): state for name, state in GUIDE["states"].items()}
RENAMED["greet"] = {**RENAMED["greet"], "onDone": "hears"}
MORE = [{"say": "Hello"}, {"say": "You"}, {"say": "Welcome"}]
CIAO = {"heard": {"guard": "event.data.result == 'ciao'", "target": "bye"}}
CHANGES = {
    "nothing": (Machine.from_dict(GUIDE), SAME, "", ""),
    "a text": (edited("bye", "do", value=[{"say": "So long"}]), SAYS, "“Goodbye” (en)", "“So long” (en)"),
    "a text more": (edited("greet", "do", value=MORE), SAYS, "“Welcome” (en)", "“You” (en)"),
    "a name of a state": (Machine.from_dict({**GUIDE, "states": RENAMED}), SAME, "", ""),
    "what leads home": (edited("bye", value={"do": [{"say": "Goodbye"}]}), ENDS, "idle", "bye"),
    "what is understood": (edited("listen", "on", value=CIAO), SAYS, "“Goodbye” (en)", "nothing"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_other_files_would_have_done(visit: RecordedVisit, change: str) -> None:
    machine, how, was, now = CHANGES[change]
    old, new = bundle(Machine.from_dict(GUIDE)), bundle(machine)
    verdict = played_against(old, new, visit, lambda *_: 1.0)
    assert verdict
    assert (verdict.how, verdict.was, verdict.now) == (how, was, now)


def test_files_that_never_come_to_rest_end_a_visit(visit: RecordedVisit) -> None:
    data = deepcopy(GUIDE)
    data["states"]["greet"] = {"after": {"1ms": "greeted"}}
    data["states"]["greeted"] = {"after": {"1ms": "greet"}}
    restless = Machine.from_dict(data)
    verdict = played_against(bundle(Machine.from_dict(GUIDE)), bundle(restless), visit, lambda *_: 1.0)
    assert verdict
    assert verdict.how == ENDS
    assert (
        verdict.now
        == f"with these files, one visit takes more than {MORE_STEPS + MOST_TIMES * len(visit.inputs):,} steps"
    )


def test_a_visit_that_begins_with_overdue_timers_is_not_played_again(tmp_path: Path) -> None:
    data: Data = {
        "id": "loops",
        "entry": [{"send": "b"}, {"send": "c"}],
        "on": {"b": {"actions": [{"send": "b"}]}, "c": {"actions": [{"send": "c"}, {"play": "wave"}]}},
        "states": {"home": {"on": {"go": "away"}}, "away": {"on": {"go": "home"}}},
    }
    run = recorded(Machine.from_dict(data), [("go", None), ("go", None)], tmp_path)
    assert [entry for entry in run.entries() if isinstance(entry, JournalJump) and entry.kind == DROPPED]
    project = next(iter(run.bundles.values()))
    verdicts = [played_against(project, project, visit, lambda *_: 1.0) for visit in of(run)]
    assert verdicts
    assert {verdict.how for verdict in verdicts if verdict} <= {SAME}


@settings(PATIENT, max_examples=8)
@given(machine_data(deeds=True), happenings)
def test_the_same_files_would_have_done_the_same(data: Data, events: Happenings) -> None:
    itself(data, events)


@pytest.mark.soak
@settings(PATIENT, max_examples=1000)
@given(machine_data(deeds=True), happenings)
def test_a_thousand_machines_do_the_same_as_they_did(data: Data, events: Happenings) -> None:
    itself(data, events)


def itself(data: Data, events: Happenings) -> None:
    with TemporaryDirectory() as folder:
        try:
            run = recorded(Machine.from_dict(deepcopy(data)), events, Path(folder), 2)
        except LumenError:
            return
        project = next(iter(run.bundles.values()))
        for visit in of(run):
            verdict = played_against(project, project, visit, lambda *_: 1.0)
            assert verdict is None or verdict.how == SAME, verdict
