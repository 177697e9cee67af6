"""Stories on a day: they begin when they say, wait until the clock shows a time, and are exact."""

from pathlib import Path

import pytest

from lumen.errors import ProjectError
from lumen.project import load
from lumen.run.rehearsal import Rehearsal, rehearse
from tests.tour.conftest import copy

__all__ = ["copy"]

DOOR = """\
initial: open
context: {seen: ''}
states:
  open:
    entry: {assign: {seen: "date() + ' ' + weekday() + ' ' + now()"}}
    at: {"mon-fri 10:01": closed, "2026-12-24 14:00": closed, "sun 02:30": closed}
  closed:
    entry: {assign: {seen: "date() + ' ' + weekday() + ' ' + now()"}}
    at: {"10:02": open}
"""


def played(copy: Path, head: str, steps: str, zone: str = "") -> Rehearsal:
    (copy / "behaviors" / "door.yaml").write_text(DOOR, "utf-8")
    (copy / "behaviors" / "stories" / "day.yaml").write_text(f"behavior: door\n{head}\nsteps:\n{steps}", "utf-8")
    settings = copy / "lumen.yaml"
    settings.write_text((f"timezone: {zone}\n" if zone else "") + settings.read_text("utf-8"), "utf-8")
    project = load(copy)
    return rehearse(project, project.stories["day"])


@pytest.mark.parametrize(
    ("head", "seen"),
    [
        ("", "2026-06-01 mon 10:00"),
        ('at: "9:30"', "2026-06-01 mon 09:30"),
        ("at: wed 09:30", "2026-06-03 wed 09:30"),
        ("at: 2026-12-24 13:59", "2026-12-24 thu 13:59"),
    ],
)
def test_a_story_begins_when_it_says(copy: Path, head: str, seen: str) -> None:
    assert played(copy, head, f"  - expect: {{context: {{seen: '{seen}'}}}}\n").failed is None


def test_a_step_waits_until_the_clock_shows_a_time(copy: Path) -> None:
    steps = """\
  - at: "10:00"
  - expect: {state: open, within: 0s}
  - at: "10:01"
  - expect: {state: closed, context: {seen: 2026-06-01 mon 10:01}, within: 20ms}
  - at: "10:02"
  - expect: {state: open, within: 20ms}
"""
    run = played(copy, "", steps)
    assert run.failed is None
    assert run.time == pytest.approx(120.0, abs=0.05)


@pytest.mark.parametrize(
    ("zone", "seen"), [("Europe/Berlin", "2026-03-29 sun 03:00"), ("Asia/Jakarta", "2026-03-29 sun 02:30")]
)
def test_the_clock_hangs_where_the_project_says(copy: Path, zone: str, seen: str) -> None:
    begin = "at: 2026-03-29 01:59" if zone == "Europe/Berlin" else "at: 2026-03-29 02:29"
    run = played(copy, begin, f"  - expect: {{state: closed, context: {{seen: '{seen}'}}, within: 61s}}\n", zone)
    assert run.failed is None


def test_what_has_passed_for_good_fails_the_story(copy: Path) -> None:
    run = played(copy, "", '  - at: "2026-05-31 10:00"\n')
    assert run.failed
    assert "is in the past" in run.failed.was


def test_a_story_begins_once(copy: Path) -> None:
    with pytest.raises(ProjectError, match="contains 2 times of day"):
        played(copy, 'at: "10:00, 11:00"', "  - wait: 1s\n")


def test_every_caption_says_the_time(copy: Path) -> None:
    from lumen.run.captions import caption
    from lumen.run.entry_causes import _trigger as told
    from lumen.statechart import initial

    (copy / "behaviors" / "door.yaml").write_text(DOOR, "utf-8")
    machine = load(copy).behaviors["door"]
    transition = machine.states["open"].transitions[0]
    assert caption(transition) == told(transition, initial(machine)) == "at mon-fri 10:01"
