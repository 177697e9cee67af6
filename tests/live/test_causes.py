"""Every event of a running exhibition names its cause, and every message its origin."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.language.causes import Cause, MessageOrigin
from lumen.language.events import Event
from lumen.language.machines import Transition
from lumen.language.projects import Project
from lumen.run.loop import caused
from lumen.statechart import Step
from tests.tables import for_each
from tests.waiting import Collector

pytestmark = pytest.mark.rest  # expensive


@pytest.fixture
def bus(tmp_path: Path) -> Iterator[Bus]:
    bus = connect(f"memory://{tmp_path}", sender="ears")
    yield bus
    bus.close()


class Tour(NamedTuple):
    """The shipped story as played: its steps, its spoken texts and its reported states."""

    project: Project
    steps: list[Step]
    said: Collector
    told: Collector


@pytest.fixture(scope="module")
def tour() -> Iterator[Tour]:
    bus = connect("memory://tour", sender="ears")
    with lumen.open(robot="recording", bus="memory://tour", story="visitor") as show:
        found = Tour(show.project, [], Collector(), Collector())
        bus.subscribe("lumen.audio.text.stream", found.said)
        bus.subscribe("lumen.NAO.state", found.told)
        show.observe(found.steps.append)
        show.run()
    yield found
    bus.close()


def test_a_tour_knows_the_cause_of_each_event(tour: Tour) -> None:
    steps, said = tour.steps, tour.said
    causes = {step.event.cause for step in steps if step.event}
    assert None not in causes
    assert {cause.kind for cause in causes if cause} >= {"message", "person", "timer", "command"}
    heard = next(step.event for step in steps if step.event and step.event.name == "heard")
    assert heard.cause is not None
    assert heard.cause[0] == "person"
    assert heard.cause.sender == "the visitor"
    assert heard.cause.key.endswith("audio.speech.recognition")
    assert heard.cause.id
    done = next(step.event for step in steps if step.event and step.event.name.startswith("done.command."))
    assert done.cause == Cause("command", done.name.removeprefix("done.command."))
    timer = next(step.event for step in steps if step.event and step.event.sendid)
    assert timer.cause == Cause("timer", timer.sendid)
    texts = [message for message in said.messages if message.key.endswith("text.stream")]
    assert texts
    assert all(message.cause[0] in "cd" and message.sender == "exhibition" for message in texts)
    assert len({message.id for message in said.messages}) == len(said.messages)


def test_what_a_step_publishes_names_the_step(bus: Bus, tmp_path: Path) -> None:
    said = Collector()
    bus.subscribe("museum.lamp.set", said)
    with lumen.open("examples/museum", robot="recording", bus=f"memory://{tmp_path}", story="visit") as show:
        show.run()
        steps = show.loop.runtime.steps
    numbers = [int(message.cause.removeprefix("step ")) for message in said.messages]
    assert numbers
    assert numbers == sorted(numbers)
    assert 1 <= numbers[0] <= numbers[-1] <= steps


def test_a_message_of_a_module_is_the_cause(bus: Bus, tmp_path: Path) -> None:
    steps: list[Step] = []
    with lumen.open(robot="recording", bus=f"memory://{tmp_path}") as show:
        show.observe(steps.append)
        show.tick()
        bus.publish(
            "lumen.audio.speech.recognition", {"name": "", "result": "dance", "date": ""}, origin=MessageOrigin("m1")
        )
        show.send("face", {"x": 160, "y": 120})
        show.tick()
        found = {step.event.name: step.event.cause for step in steps if step.event and step.event.cause}
    assert found["heard"][:4] == ("message", "m1", "lumen.audio.speech.recognition", "ears")
    assert found["heard"].time > 1.6e9
    assert found["face"][0] == "message"
    assert found["face"].sender == "the program"


@for_each(
    ("event", "cause"),
    [
        (Event("done.command.d3"), Cause("command", "d3")),
        (Event("stop", {"by": "Ana"}), Cause("person", sender="Ana")),
        (Event("resume", {}), Cause("person")),
        (Event("touched", {"sensor": "FrontTactil"}), Cause("robot")),
        (Event("fallen", {}), Cause("robot")),
        (Event("lost.command.d7", {}), Cause("start", "d7")),
        (Event("brain.lost", {"seconds": 7.0}), Cause("start")),
        (Event("heard", {}, cause=Cause("message", "m")), Cause("message", "m")),
    ],
)
def test_what_nobody_named_a_cause_of_has_one(event: Event, cause: Cause) -> None:
    assert caused(event) == event._replace(cause=cause)


def test_the_state_says_where_the_transition_stands_and_what_caused_it(tour: Tour) -> None:
    project = tour.project
    bodies = [message.body for message in tour.told.messages]
    steps = [body for body in bodies if body.get("transitions")]
    assert [body["step"] for body in steps] == sorted({body["step"] for body in steps})
    heard = next(body for body in steps if body["event"] == "heard")
    assert heard["data"]["result"]
    assert heard["cause"]["kind"] == "person"
    assert heard["bundle"] == project.hash
    taken = heard["transitions"][0]
    source = Path(project.root, taken["file"]).read_text("utf-8").splitlines()
    assert taken["file"] == "behaviors/tour.yaml"
    assert set(taken["targets"]) & {transition.targets[0] for transition in _candidates(project) if transition.targets}
    assert source[taken["line"] - 1].strip()
    asked = [body["step"] for body in bodies if "command" in body]
    assert asked == sorted(asked)
    assert set(asked) & {body["step"] for body in steps}


def _candidates(project: Project) -> Iterator[Transition]:
    for state in project.machine.states.values():
        yield from state.transitions
