"""A button that performs a skill, or other actions: pressed, refused, linted, explained and written."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.insight.explaining.pressing import pressed, shown_buttons
from lumen.project import load
from lumen.project.formats.behavior_data import plain_button
from lumen.statechart import Machine, initial, step
from tests.features.skills.changing import BEHAVIOR, STORY, found, project_in
from tests.features.skills.test_stories import failure_of
from tests.tables import for_each

WAITING = "waiting: {on: {face: spraying}}"


def button(row: str) -> dict[str, tuple[str, str]]:
    """Return the change that gives the state `waiting` a button."""
    return {BEHAVIOR: (WAITING, f"waiting:\n    on: {{face: spraying}}\n    buttons: [{row}]")}


@for_each(
    ("row", "finding"),
    [
        ("{label: Fog, actions: {spray: 3s}}", ""),
        ("{label: Fog, actions: [{say: Look!}, {spray: {duration: 3s, nozzle: right}}], key: f}", ""),
        ("{label: Fog, actions: {spry: 3s}}", "unknown-key | `spry` is not a key of `actions` | did you mean `spray`?"),
        ("{label: Fog, actions: {spray: 3 hours}}", "bad-duration | `3 hours` is not a duration"),
        ("{label: Fog, actions: {wait: 3s}}", "only-in-do | `wait` is allowed only in `do`"),
        (
            "{label: Fog, actions: {spray: 3s}, event: fog}",
            "unknown-key | `event` is not allowed in item 1 of",
        ),
        ("{label: Fog}", "missing-key | "),
    ],
)
def test_lint_checks_the_actions_of_a_button(tmp_path: Path, row: str, finding: str) -> None:
    lines = found(project_in(tmp_path, button(row)))
    assert [finding in line for line in lines] == ([True] if finding else []), lines


def test_a_pressed_button_performs_a_skill_and_the_state_stays(tmp_path: Path) -> None:
    root = project_in(tmp_path, button("{label: {en: Fog!, id: Kabut!}, actions: {spray: 3s}}"))
    steps = "[{operator: {press: kabut!}}, {expect: {did: {spray: 3s}, state: waiting}}]"
    assert failure_of(root, steps) == ""
    machine = load(root).machine
    snapshot = initial(machine).snapshot
    event = pressed(machine, snapshot, "Fog!", 0.0, "Aisyah")
    assert not isinstance(event, str)
    assert event.name == "button.waiting.fog"
    assert [shown.enabled for shown in shown_buttons(machine, snapshot, 0.0)] == [True]


def test_two_buttons_of_one_label_do_what_each_says() -> None:
    rows = [{"label": "Go", "actions": {"raise": "a"}}, {"label": "Go!", "actions": {"raise": "b"}}]
    data = {"states": {"hall": {"buttons": rows, "on": {"a": "one", "b": "two"}}, "one": {}, "two": {}}}
    machine = Machine.from_dict(data)
    first, second = machine.states["hall"].buttons
    assert (first.event, second.event) == ("button.hall.go", "button.hall.go_2")
    snapshot = initial(machine).snapshot
    event = pressed(machine, snapshot, "Go!", 0.0, "Aisyah")
    assert not isinstance(event, str)
    assert step(machine, snapshot, event).snapshot.configuration == frozenset({"two"})


def test_a_button_is_written_as_an_event_with_its_transition() -> None:
    rows = [{"label": {"en": "Fog"}, "actions": {"raise": "a"}, "key": "f"}]
    machine = Machine.from_dict({"states": {"hall": {"buttons": rows, "on": {"a": {}}}}})
    (one,) = machine.states["hall"].buttons
    assert plain_button(one) == {"label": {"en": "Fog"}, "event": "button.hall.fog", "key": "f"}
    assert [each.event for each in machine.states["hall"].transitions] == ["button.hall.fog", "a"]


@pytest.mark.process
def test_why_names_the_button_of_a_skill(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = project_in(tmp_path, button("{label: Fog, actions: {spray: 3s}}"))
    (root / STORY).write_text("steps: [{operator: {press: Fog}}, {expect: {did: {spray: 3s}}}]\n", "utf-8")
    assert main(["run", str(root), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    capsys.readouterr()
    assert main(["why", "spray", str(root)]) == 0
    shown = capsys.readouterr().out
    assert "button.waiting.fog" in shown
    assert "the operator" in shown
