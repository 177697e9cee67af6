"""A robot of another body on the other side of the bus: it performs as it does here, and refuses in the same words."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.language.commands import GoTo, Look, Posture, Start, Track, Walk
from lumen.language.projects import Project
from lumen.ports import Aim, Joints, Perform, RobotCommand, Sense, Sonar
from lumen.project.chosen_model import MODEL_VARIABLE
from lumen.robot.recording import RecordingRobot
from lumen.run.performer import LEFT_OUT, Performer
from tests import ROOT
from tests.seams.test_robot import Remote, live
from tests.tour.conftest import copied

Made = Callable[[Project], Remote]


@pytest.fixture
def remote() -> Iterator[Made]:
    made: list[Remote] = []

    def make(project: Project) -> Remote:
        made.append(Remote(project))
        return made[-1]

    yield make
    for one in made:
        one.close()


def performed_by(model: str) -> Project:
    """Return the shipped exhibition with that body."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(MODEL_VARIABLE, model)
        return lumen.load(ROOT)


def angles(robot: Remote) -> dict[str, float]:
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    return dict(zip(joints.names, joints.angles, strict=True))


def answer(robot: Remote | RecordingRobot, command: RobotCommand) -> tuple[str, object]:
    """Return the kind and data of a command's answer within 15 s. Ids differ, so that no command is repeated."""
    robot.start(repr(command)[:20], command)
    [event] = [event for event in live(robot, 15.0) if ".command." in event.name]
    return event.name.split(".")[0], event.data


def test_a_greeter_drives_and_looks_over_the_bus(remote: Made) -> None:
    project = performed_by("greeter")
    robot = remote(project)
    assert answer(robot, Walk(0.3, 0.0, 0.5))[0] == "done"
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.position is not None
    assert (joints.position.x, joints.position.theta) == pytest.approx((0.3, 0.5), abs=1e-3)
    assert answer(robot, Look(0.4, 0.2))[0] == "done"
    assert angles(robot).keys() == project.body.joints.keys()
    assert (angles(robot)["neck_turn"], angles(robot)["neck_nod"]) == pytest.approx((0.4, 0.2), abs=1e-3)
    robot.start("", Aim({"neck_turn": -0.3}))
    live(robot, 3.0)
    assert angles(robot)["neck_turn"] == pytest.approx(-0.3, abs=1e-3)
    assert isinstance(robot.read(Sense.SONAR), Sonar)
    assert answer(robot, Posture("Welcome"))[0] == "done"
    assert answer(robot, Perform(project.motions["goodbye"]))[0] == "done"


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (Walk(0.2), "`walk`: Lantern has neither legs nor wheels"),
        (Posture("Crouch"), "no posture `Crouch`: "),
    ],
)
def test_a_lantern_refuses_there_as_it_does_here(remote: Made, command: RobotCommand, words: str) -> None:
    project = performed_by("lantern")
    far, near = answer(remote(project), command), answer(RecordingRobot(project.body), command)
    assert far == near
    assert far[0] == "error"
    assert words in str(far[1])
    assert remote(project).read(Sense.SONAR) is None


def test_without_a_head_nothing_looks_and_nothing_is_tracked(remote: Made, tmp_path: Path) -> None:
    """Lint, the robot here and there, and the transcript of the caller use the same words."""
    folder = copied(tmp_path)
    model = folder / "models" / "lantern.yaml"
    model.write_text(model.read_text("utf-8").replace("  head: {yaw: turn, pitch: nod, roll: tilt}\n", ""), "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(MODEL_VARIABLE, "lantern")
        project, found = lumen.load(folder), lumen.check(folder)
    look = answer(remote(project), Look(0.2))
    assert look == answer(RecordingRobot(project.body), Look(0.2))
    assert look[1] == {"reason": "`look`: Lantern has no head that turns"}
    switched: list[Track] = []
    performer = Performer(remote(project), MemoryBus(), switched.append)
    performer.perform(project, Start("b", Track("head")), 0.0)
    performer.perform(project, Start("c", GoTo("desk")), 0.0)
    said = [str(event.data[LEFT_OUT]) for event in performer.events]
    assert said == ["Lantern has no `head.yaw`, `head.pitch`", "Lantern has neither legs nor wheels"]
    assert not switched
    assert any(f"{said[0]}, so it leaves out `track`" == finding.message for finding in found)
    performer.perform(performed_by("lantern"), Start("d", Track("head")), 0.0)
    assert switched == [Track("head")]
