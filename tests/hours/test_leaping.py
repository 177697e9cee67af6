"""Hours in which nothing happens are skipped, and the results are the same."""

from pathlib import Path

import pytest

from lumen.language.projects import Project
from lumen.project import load
from lumen.run.node import Node
from lumen.run.rehearsal import rehearse
from tests.tour.conftest import copy, project

__all__ = ["copy", "project"]

DAY = """\
initial: closed
states:
  closed: {at: {"mon-sat 09:00": open}}
  open:
    entry: {say: {en: Come in!, id: Silakan masuk!}}
    after: {90s: .shown}
    at: {"18:00": closed}
    initial: waiting
    states: {waiting: {}, shown: {}}
"""
WEEK = """\
behavior: day
at: "08:00"
steps:
  - wait: 50min
  - expect: {state: open, said: Come in!, within: 11min}
  - expect: {state: open.shown, within: 91s}
  - wait: 8h
  - expect: {state: closed, within: 1h}
  - at: sun 12:00
  - expect: {state: closed}
  - at: mon 09:00
  - expect: {state: open, within: 20ms}
"""


GUIDE = """\
events: {start: null}
initial: idle
states:
  idle: {on: {start: telling}, after: {7min: bored}}
  telling:
    do:
      - say: {en: Ask me., id: Tanya saya.}
      - wait: 3s
      - parallel: [{say: {en: Come., id: Mari.}}, {play: goodbye}]
      - walk: {x: 0.1}
    onDone: over
    after: {3min: idle}
  over: {after: {5s: idle}, on: {touched: telling}}
  bored: {do: [{say: {en: La la., id: La la.}}, {raise: yawn}], on: {yawn: idle, face: idle}}
"""
ROUND = """\
behavior: guide
steps:
  - wait: 100s
  - event: start
  - expect: {state: telling, said: Ask me}
  - expect: {state: over, played: goodbye, within: 2min}
  - touch: MiddleTactil
  - release: MiddleTactil
  - expect: {state: telling}
  - expect: {state: idle, within: 10min}
  - wait: 10min
  - expect: {state: idle, said: La la}
  - visitor: arrives
  - wait: 10s
  - visitor: leaves
  - wait: 10min
  - expect: {state: idle}
"""


def test_every_story_of_the_tour_goes_the_same_way(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = ("safety_head", "silent", "battery", "visitor")
    stories = [story for name, story in project.stories.items() if name.startswith(chosen)]
    assert len(stories) >= 3
    fast = [rehearse(project, story, whole=True) for story in stories]
    monkeypatch.setattr(Node, "_leap", lambda _: None)
    slow = [rehearse(project, story, whole=True) for story in stories]
    assert [(run.time, run.trace) for run in fast] == [(run.time, run.trace) for run in slow]


def test_what_comes_one_after_the_other_comes_when_it_came(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (copy / "behaviors" / "guide.yaml").write_text(GUIDE, "utf-8")
    (copy / "behaviors" / "stories" / "round.yaml").write_text(ROUND, "utf-8")
    project = load(copy)
    fast = rehearse(project, project.stories["round"], whole=True)
    assert fast.failed is None
    monkeypatch.setattr(Node, "_leap", lambda _: None)
    slow = rehearse(project, project.stories["round"], whole=True)
    assert (fast.time, fast.trace) == (slow.time, slow.trace)


def test_a_week_takes_a_moment(copy: Path) -> None:
    (copy / "behaviors" / "day.yaml").write_text(DAY, "utf-8")
    (copy / "behaviors" / "stories" / "week.yaml").write_text(WEEK, "utf-8")
    project = load(copy)
    passed: list[float] = []
    run = rehearse(project, project.stories["week"], hooks=[passed.append])
    assert run.failed is None
    assert run.time == pytest.approx(7 * 86400 + 3600, abs=0.05)
    assert len(passed) < 2000  # of thirty million ticks
