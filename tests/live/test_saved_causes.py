"""Events caused by a saved file or a touch name their cause; the steps of invoked behaviours are reported too."""

from pathlib import Path

import pytest

import lumen
from lumen.insight.replay.replaying import replay
from lumen.language.causes import VISITOR, Cause
from lumen.run.replaying.journals import KeptBundles, chosen
from tests import ROOT
from tests.copying import copied_project
from tests.live.shows import Live
from tests.waiting import Collector

pytestmark = pytest.mark.rest  # expensive

HELLO = "behaviors/hello.yaml"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return copied_project(ROOT / "examples" / "minimal", tmp_path / "minimal")


def test_states_that_a_saved_file_enters_are_told_with_the_file(folder: Path) -> None:
    live = Live(folder)
    said = Collector()
    live.show.loop.bus.subscribe("lumen.state", said)
    live.edit("{on: {face: greeting}}", "{on: {face: greeting}, initial: calm, states: {calm: {}}}", HELLO)
    live.until_told("are active")
    live.until(lambda: any(body.get("cause", {}).get("kind") == "file" for body in said.bodies))
    body = next(body for body in said.bodies if body.get("cause", {}).get("kind") == "file")
    assert body["cause"]["id"] == HELLO
    assert "waiting.calm" in body["entered"]
    live.close()


def test_a_hand_is_a_persons() -> None:
    steps = []
    with lumen.open(ROOT, robot="recording", bus="memory://hands") as show:
        show.observe(steps.append)
        assert show.services.setup.hall
        show.run(seconds=1)
        show.services.setup.hall.touch("MiddleTactil", True)
        show.run(seconds=1)
    event = next(step.event for step in steps if step.event and step.event.name == "touched")
    assert event.cause == Cause("person", sender=VISITOR)


def test_a_timer_that_is_replayed_says_so(folder: Path) -> None:
    story = "title: t\nsteps: [visitor: arrives, expect: {state: greeting}, visitor: leaves, wait: 40s]\n"
    (folder / "behaviors/stories/visitor.yaml").write_text(story, "utf-8")
    with lumen.open(folder, story="visitor") as show:
        show.run()
    rows = [row.step.event for row in replay(chosen(folder, None).entries(), KeptBundles(folder).machine) if row.step]
    timers = [event for event in rows if event and event.sendid]
    assert timers
    assert all(event.cause == Cause("timer", event.sendid) for event in timers)


def test_transitions_of_invoked_behaviours_are_told(folder: Path) -> None:
    live_behavior = (folder / HELLO).read_text("utf-8")
    invoking = "{invoke: {behavior: inner, id: quiz}, on: {face: greeting}}"
    (folder / HELLO).write_text(live_behavior.replace("{on: {face: greeting}}", invoking), "utf-8")
    (folder / "behaviors/inner.yaml").write_text("states: {one: {after: {1s: two}}, two: {}}\n", "utf-8")
    live = Live(folder)
    said = Collector()
    live.show.loop.bus.subscribe("lumen.state", said)
    live.live(3.0)
    taken = [row for body in said.bodies for row in body.get("transitions", ())]
    assert [(row["source"], row["targets"], row["file"], row["line"]) for row in taken] == [
        ("quiz/one", ["quiz/two"], "behaviors/inner.yaml", 1)
    ]
    live.close()
