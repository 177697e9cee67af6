"""`life` of states: the style that applies, and the time at which the robot receives it."""

import pytest

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.language.life import STILL
from lumen.language.machines import MachineDefinition
from lumen.motion.life import style_name
from lumen.ports import Live, RobotCommand, Sense
from lumen.robot.recording import RecordingRobot
from lumen.run.rehearsal import rehearse
from lumen.run.setup import Setup
from lumen.statechart import Machine
from tests import ROOT
from tests.tables import for_each

TWO = """
id: two
type: parallel
life: calm
states:
  guide:
    states:
      idle: {on: {face: talk}}
      talk:
        life: lively
        states:
          ask: {life: listening, on: {heard: tell}}
          tell: {}
  safety:
    states:
      well: {on: {fallen: lies}}
      lies: {life: still}
"""


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> MachineDefinition:
    file = tmp_path_factory.mktemp("life") / "two.yaml"
    file.write_text(TWO)
    return Machine.load(file)


@for_each(
    ("active", "name"),
    [
        ({"guide", "guide.idle", "safety", "safety.well"}, "calm"),
        ({"guide", "guide.talk", "guide.talk.tell", "safety", "safety.well"}, "lively"),
        ({"guide", "guide.talk", "guide.talk.ask", "safety", "safety.well"}, "listening"),
        ({"guide", "guide.talk", "guide.talk.ask", "safety", "safety.lies"}, STILL),
        (set(), "calm"),
    ],
)
def test_the_innermost_state_decides_and_still_before_all(
    machine: MachineDefinition, active: set[str], name: str
) -> None:
    assert style_name(machine, active) == name


def test_a_behaviour_that_says_nothing_is_still() -> None:
    machine = lumen.load(ROOT / "examples/minimal").machine
    assert style_name(machine, {state.name for state in machine.states.values()}) == STILL


class Listening(RecordingRobot):
    """A recording robot that keeps the styles of life that it received."""

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Live):
            self.styles.append(command.style.name)
        super().start(id, command)


def test_the_tour_is_calm_then_lively_then_listens() -> None:
    project = lumen.load(ROOT)
    robot = Listening(project.body, {})
    robot.styles = []
    clock = SimulatedClock(robot.advance)
    done = rehearse(project, project.stories["visitor"], Setup(robot, clock, robot))
    assert done.failed is None
    order = list(dict.fromkeys(robot.styles))
    assert order == ["calm", "lively", "listening"]
    assert not any(isinstance(command, Live) for _, command in robot.performed)


def test_the_recording_robot_shows_life_in_its_joints() -> None:
    project = lumen.load(ROOT)
    robot = RecordingRobot(project.body)
    before = robot.read(Sense.JOINT)
    robot.start("", Live(project.life["lively"]))
    robot.advance(1.0)
    first = robot.read(Sense.JOINT)
    robot.advance(1.0)
    assert before is not None
    assert first is not None
    assert before.angles != first.angles != robot.read(Sense.JOINT).angles
