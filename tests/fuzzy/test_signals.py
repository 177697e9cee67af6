"""A museum's two controllers in an exhibition: the volume by the visitor's distance, and the brightness of a lamp."""

from itertools import pairwise
from pathlib import Path

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.cli.main import main
from lumen.clock.virtual import VirtualClock
from lumen.insight.migration import MigrationPlan
from lumen.language.commands import Start, Track, Volume
from lumen.robot.recording import RecordingRobot
from lumen.run.exploring import explored
from lumen.run.loop import BehaviorLoop, Observer
from lumen.run.rehearsal import rehearse
from lumen.run.setup import set_up
from lumen.statechart import Step, step

FILES = {
    "lumen.yaml": """\
name: Museum
behavior: guide
languages: [en]
robot: {name: NAO, model: nao}
routes:
  sonar: {key: "avatar.{robot}.data.sonar", direction: out, schema: sonar, every: 100ms}
  crowd: {key: museum.crowd, direction: in, schema: crowd}
  lamp: {key: museum.lamp.set, direction: out, schema: lamp}
""",
    "schemas/messages/crowd.schema.json": """\
{"type": "object", "properties": {"people": {"type": "integer", "minimum": 0}}, "required": ["people"]}
""",
    "schemas/messages/lamp.schema.json": """\
{"type": "object", "additionalProperties": false, "required": ["lamp", "brightness"], "properties": {
  "lamp": {"type": "string"}, "brightness": {"type": "integer", "minimum": 0, "maximum": 255}}}
""",
    "behaviors/guide.yaml": """\
context: {calm: 1}
initial: greeting
states:
  greeting:
    entry: [{track: {loudness: true}}, {track: {light: true}}]
    after: {5s: waiting}
  waiting:
    always: {guard: context.calm < 0.5, target: shy}
    on: {crowded: proud}
  proud:
    entry: {say: So many of you!}
    always: {guard: context.calm < 0.2, target: shy}
  shy:
    entry: [{track: {loudness: false}}, {track: {light: false}}]
    after: {1min: greeting}
""",
    "fuzzy/loudness.yaml": """\
# Speaks the louder, the farther away the visitor is.
inputs:
  Distance: {range: [0.25, 2.55], unit: m, lock-range: true, terms: {Near: {ramp: [2, 0.5]}, Far: {ramp: [0.5, 2]}}}
outputs:
  Loudness: {range: [0, 1], terms: {Soft: {constant: 0.4}, Loud: {constant: 1}}}
rules:
  - if Distance is Near then Loudness is Soft
  - if Distance is Far then Loudness is Loud
operators: {defuzzifier: weighted-average}
bind:
  inputs: {Distance: sonar.leftSensor}
  outputs: {Loudness: volume}
""",
    "fuzzy/light.yaml": """\
# The more people there are, the brighter is the lamp, and the less calm the robot.
inputs:
  People: {range: [0, 20], lock-range: true, terms: {Few: {ramp: [20, 0]}, Many: {ramp: [0, 20]}}}
outputs:
  Brightness: {range: [0, 255], terms: {Dim: {constant: 20}, Bright: {constant: 255}}}
  Crowd: {range: [0, 1], terms: {Low: {constant: 0}, High: {constant: 1}}}
  Calm: {range: [0, 1], terms: {Low: {constant: 0}, High: {constant: 1}}}
rules:
  - if People is Few then Brightness is Dim, Crowd is Low, Calm is High
  - if People is Many then Brightness is Bright, Crowd is High, Calm is Low
operators: {defuzzifier: weighted-average}
bind:
  inputs: {People: crowd.people}
  outputs:
    Brightness: {message: lamp.brightness, body: {lamp: organ}}
    Crowd: {event: crowded, above: 0.45}
    Calm: {context: calm}
""",
    "behaviors/stories/people.yaml": """\
title: Somebody comes close, then many come
behavior: guide
steps:
  - wait: 1s
  - visitor: {x: 0.4, y: 0}
  - wait: 5s
  - visitor: leaves
  - wait: 5s
  - message: {route: crowd, body: {people: 4}}
  - expect: {published: {route: lamp, body: {lamp: organ, brightness: 67}}, context: {calm: 0.8}}
  - expect: {state: waiting}
  - message: {route: crowd, body: {people: 10}}
  - expect: {state: proud, said: So many, published: {route: lamp, body: {brightness: 138}}}
  - message: {route: crowd, body: {people: 20}}
  - expect: {state: shy, context: {calm: 0}, published: {route: lamp, body: {brightness: 255}}}
""",
}


@pytest.fixture
def museum(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return tmp_path


def test_the_story_holds_and_lint_finds_nothing(museum: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", "--strict", str(museum)]) == 0, capsys.readouterr().out
    assert main(["test", str(museum), "people"]) == 0, capsys.readouterr().out


def test_the_volume_follows_the_visitor(museum: Path) -> None:
    project = lumen.load(museum)
    setup = set_up("recording", project, "max", project.stories["people"])
    went = rehearse(project, project.stories["people"], setup)
    assert went.failed is None, went.failed
    assert isinstance(setup.robot, RecordingRobot)
    volumes = [(time, command.level) for time, command in setup.robot.performed if isinstance(command, Volume)]
    levels = [level for _, level in volumes]
    there = levels.index(min(levels))
    assert (levels[0], min(levels), levels[-1]) == (1.0, 0.4, 1.0), "nobody, somebody at the robot, nobody"
    assert levels[: there + 1] == sorted(levels[: there + 1], reverse=True)
    assert levels[there:] == sorted(levels[there:])
    assert volumes[0][0] < 0.5, "told as soon as the sonar has said something"
    assert not any(4.0 < time < 6.0 for time, _ in volumes), "nothing while nobody moves"
    assert min(b - a for (a, _), (b, _) in pairwise(volumes)) > 0.19


class Hall:
    """The museum's behaviour on a bus and a robot of its own, tick by tick."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.robot, self.bus = folder, RecordingRobot(lumen.load(folder).body), MemoryBus()
        self.loop = BehaviorLoop(lumen.load(folder), self.robot, self.bus, VirtualClock())
        self.lamps: list[object] = []
        self.bus.subscribe("museum.lamp.set", lambda message: self.lamps.append(message.body))
        self.loop.start()

    def people(self, number: object) -> None:
        """Publish this number of people, then run for half a second."""
        self.bus.publish("museum.crowd", {"people": number})
        for _ in range(25):
            self.loop.tick()
            self.robot.advance(0.02)

    def edit(self, old: str, new: str) -> None:
        """Save the file of the light with that edit."""
        file = self.folder / "fuzzy" / "light.yaml"
        assert old in file.read_text("utf-8")
        file.write_text(file.read_text("utf-8").replace(old, new), "utf-8")
        project = lumen.load(self.folder)
        plan = self.loop.plan(project)
        assert isinstance(plan, MigrationPlan), plan
        self.loop.apply(project, plan)

    @property
    def calm(self) -> object:
        return self.loop.runtime.snapshot.context["calm"]


def test_messages_that_are_no_good_change_nothing(museum: Path) -> None:
    hall = Hall(museum)
    for number in ("many", None, True, [4]):
        hall.people(number)
    assert (hall.lamps, hall.calm) == ([], 1)
    hall.people(4)
    assert (hall.lamps, hall.calm) == ([{"lamp": "organ", "brightness": 67}], 0.8)


def test_a_saved_controller_goes_on_with_what_it_knew(museum: Path) -> None:
    hall = Hall(museum)
    hall.people(4)
    hall.edit("# The more", "# The many more")
    hall.people(4)
    assert len(hall.lamps) == 1, "nothing has changed for the lamp"
    hall.edit("body: {lamp: organ}", "body: {lamp: harp}")
    hall.people(4)
    assert hall.lamps[1:] == [{"lamp": "harp", "brightness": 67}], "bound otherwise: told, with the people known before"
    hall.edit("Calm: {context: calm}", "Calm: {event: crowded, below: 0.1}")
    hall.people(10)
    assert (hall.calm, len(hall.lamps)) == (0.8, 3), "what it set stays"


def test_a_controller_that_is_switched_off_says_nothing(museum: Path) -> None:
    hall = Hall(museum)
    hall.loop.performer.perform(hall.loop.project, Start("c9", Track("light", False)), 0.0)
    hall.people(20)
    assert hall.lamps == []
    hall.loop.performer.perform(hall.loop.project, Start("c10", Track("light")), 0.0)
    hall.people(20)
    assert hall.lamps == [{"lamp": "organ", "brightness": 255}]


def test_the_same_events_give_the_same_steps_without_a_controller(museum: Path) -> None:
    hall = Hall(museum)
    steps: list[Step] = []
    observer = Observer()
    observer.stepped = steps.append  # type: ignore[method-assign]
    hall.loop.observers.append(observer)
    before = hall.loop.runtime.snapshot
    for number in (2, 6, 12):
        hall.people(number)
    assert hall.calm == 0.4
    for taken in steps:
        assert taken.event is not None
        before = step(hall.loop.project.machine, before, taken.event).snapshot
    assert before == steps[-1].snapshot


def test_exploring_comes_wherever_controllers_lead(museum: Path) -> None:
    found = explored(lumen.load(museum), "guide", bound=1_000)
    assert (found.findings, found.unseen) == ((), ())
