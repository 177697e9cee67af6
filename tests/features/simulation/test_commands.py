"""The simulated robot's response to commands, valid and absurd."""

from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from lumen.errors import RobotError
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look, Posture, Say, Stop, Walk
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.ports import Aim, Perform, RobotCommand
from tests.features.simulation.conftest import MODELS, Do, answer, until_answered
from tests.scanning import matching

WAVE = MotionDefinition(
    "wave",
    2.0,
    {
        "RShoulderPitch": (Keyframe(0.8, -1.0), Keyframe(2.0, 1.44)),
        "RHand": (Keyframe(0.8, 1.0), Keyframe(2.0, 0.3)),
        "LHipPitch": (Keyframe(1.0, 0.0), Keyframe(2.0, 0.127)),
        "RHipPitch": (Keyframe(1.0, 0.0), Keyframe(2.0, 0.127)),
    },
    (Cue(0.5, "leds", {"eyes": "red"}), Cue(0.5, "hold", "microphone")),
    start="Stand",
)


def index(robot: SimulatedRobot, joint: str) -> float:
    return float(robot.world.angles[robot.motors.index[joint]])


def test_a_text_takes_its_time(robot: SimulatedRobot, do: Do) -> None:
    assert do(Say("0123456789")) == "done"
    assert robot.time == pytest.approx(1.0, abs=0.05)


def test_a_motion_moves_what_it_says_and_ends_where_it_began(robot: SimulatedRobot) -> None:
    materials = robot.world.model.mat_rgba
    eye, microphone = (robot.world.model.material(f"nao/{n}").id for n in ("left_eye", "microphone"))
    robot.start("m", Perform(WAVE))
    robot.advance(1.0)
    assert index(robot, "RShoulderPitch") == pytest.approx(-0.9, abs=0.25)
    assert index(robot, "RHand") > 0.8
    assert tuple(materials[eye, :3]) == pytest.approx((1.0, 0.19, 0.125), abs=0.01)
    assert materials[microphone, 3] == 1.0
    assert answer(until_answered(robot, "m"), "m") == "done"
    assert robot.time == pytest.approx(2.0, abs=0.05)
    assert materials[microphone, 3] == 0.0
    robot.advance(0.5)
    assert index(robot, "RShoulderPitch") == pytest.approx(1.44, abs=0.05)
    assert robot.greatest_tilt < 20


def test_a_motion_begins_from_its_posture_wherever_the_robot_is(robot: SimulatedRobot, do: Do, body: Body) -> None:
    assert do(Posture("Crouch")) == "done"
    assert do(Perform(WAVE)) == "done"
    robot.advance(0.5)
    assert index(robot, "LKneePitch") == pytest.approx(body.postures["Stand"]["LKneePitch"], abs=0.05)
    assert robot.greatest_tilt < 20


@pytest.mark.parametrize("moment", [0.3, 0.9, 1.6])
def test_a_cancelled_motion_is_over_within_a_second(robot: SimulatedRobot, moment: float) -> None:
    robot.start("m", Perform(WAVE))
    robot.advance(moment)
    robot.cancel("m")
    assert answer(until_answered(robot, "m"), "m") == "cancelled"
    assert robot.time <= moment + 1.0
    robot.advance(1.0)
    assert robot.greatest_tilt < 20
    assert index(robot, "RShoulderPitch") == pytest.approx(1.44, abs=0.05)


def test_stop_halts_a_change_of_posture_on_its_feet(robot: SimulatedRobot) -> None:
    robot.start("p", Posture("Crouch", 0.3))
    robot.advance(1.0)
    robot.start("s", Stop())
    events = until_answered(robot, "s")
    assert answer(events, "p") == "cancelled"
    assert robot.time <= 1.6
    robot.advance(3.0)
    assert robot.greatest_tilt < 20
    assert 0.2 < index(robot, "LKneePitch") < 2.0


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (Posture("Handstand"), "no posture `Handstand`: did you mean `Stand"),
        (Posture("Stand", nan), "a speed must be above 0"),
        (Posture("Stand", 0.0), "a speed must be above 0"),
        (Walk(nan), "there is no way to (nan, 0.0, 0.0)"),
        (Look(nan, 0.0), "`HeadYaw` cannot move to nan"),
        (Perform(MotionDefinition("m", 1.0, {"Nose": (Keyframe(1.0, 0.0),)})), "`Nose` is not a joint"),
        (Perform(MotionDefinition("m", 1.0, {"HeadYaw": (Keyframe(1.0, nan),)})), "is not a number"),
        (Perform(MotionDefinition("m", inf, {"HeadYaw": (Keyframe(1.0, 0.0),)})), "is not a number"),
        (
            Perform(MotionDefinition("m", 1.0, {"HeadYaw": (Keyframe(1.0, 0.0),)}, start="Sit")),
            "begins in Sit; the robot is in Stand",
        ),
    ],
)
def test_what_it_can_t_do_is_an_answer_and_leaves_it_unmoved(
    robot: SimulatedRobot, do: Do, command: RobotCommand, reason: str
) -> None:
    goal = robot.motors.goal.copy()
    result = do(command)
    assert result.startswith("error: ")
    assert reason in result
    assert (robot.motors.goal == goal).all()


def test_an_aim_moves_free_joints_at_its_speed(robot: SimulatedRobot) -> None:
    robot.start("", Aim({"HeadYaw": 0.5, "HeadPitch": -0.3}, speed=0.1))
    robot.advance(0.3)
    assert index(robot, "HeadYaw") == pytest.approx(0.1 * 8.268 * 0.3, abs=0.06)
    robot.advance(1.0)
    assert index(robot, "HeadYaw") == pytest.approx(0.5, abs=0.02)
    assert index(robot, "HeadPitch") == pytest.approx(-0.3, abs=0.02)
    assert not robot.poll()


def test_an_aim_leaves_joints_alone_that_a_command_owns(robot: SimulatedRobot) -> None:
    robot.start("l", Look(-0.5, 0.0))
    robot.advance(0.1)
    robot.start("", Aim({"HeadYaw": 1.0}, speed=1.0))
    until_answered(robot, "l")
    robot.advance(0.5)
    assert index(robot, "HeadYaw") == pytest.approx(-0.5, abs=0.02)


@pytest.mark.parametrize("aim", [Aim({"HeadYaw": nan}), Aim({"Nose": 0.0}), Aim({"HeadYaw": 1.0}, nan), Aim({}, -1.0)])
def test_an_absurd_aim_is_refused(robot: SimulatedRobot, aim: Aim) -> None:
    goal = robot.motors.goal.copy()
    robot.start("", aim)
    robot.advance(0.1)
    assert (robot.motors.goal == goal).all()


def test_absurd_angles_move_joints_inside_limits_and_speeds(robot: SimulatedRobot, body: Body) -> None:
    random = np.random.default_rng(1)
    upper = [*body.parts["head"], *body.parts["arms"]]
    low = np.array([j.minimum for j in body.joints.values()])
    high = np.array([j.maximum for j in body.joints.values()])
    fastest = np.zeros(26)
    for _ in range(30):
        robot.start("", Aim({n: random.uniform(-100, 100) for n in upper}, speed=1.0))
        for _ in range(10):
            before = robot.motors.command.copy()
            robot.advance(0.01)
            fastest = np.maximum(fastest, np.abs(robot.motors.command - before) / 0.01)
            assert (robot.world.angles >= low - 0.05).all()
            assert (robot.world.angles <= high + 0.05).all()
    assert (fastest <= robot.motors.envelope.speed * 1.0001).all()


def test_the_same_seed_gives_the_same_run(body: Body) -> None:
    def run() -> list[float]:
        robot = SimulatedRobot(body, MODELS, "hall.xml", seed=3)
        robot.start("m", Perform(WAVE))
        robot.advance(1.0)
        robot.start("", Aim({"HeadYaw": 0.7}))
        robot.advance(2.0)
        return [*robot.world.data.qpos.tolist(), *robot.world.data.qvel.tolist()]

    assert run() == run()


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("nao.xml", "this is not XML", "nao.xml is not MJCF"),
        ("nao.xml", "<mujoco><worldbody/></mujoco>", "lacks what the simulation needs: .*the joint `HeadYaw`"),
        ("nao.xml", None, "no model nao.xml"),
        ("hall.xml", "<mujoco><worldbody/></mujoco>", "needs: the site `stage`"),
    ],
)
def test_a_model_that_can_t_be_used_is_said_to_be(
    body: Body, tmp_path: Path, name: str, content: str | None, reason: str
) -> None:
    for source in matching(MODELS, "**/*"):
        target = tmp_path / source.relative_to(MODELS)
        target.mkdir(exist_ok=True) if source.is_dir() else target.write_bytes(source.read_bytes())
    (tmp_path / name).unlink()
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(RobotError, match=reason):
        SimulatedRobot(body, tmp_path, "hall.xml")


def test_interpolation_is_the_motion_s_business(robot: SimulatedRobot, do: Do) -> None:
    keys = tuple(Keyframe(0.2 * k, 0.2 * (-1) ** k, Interpolation.LINEAR) for k in range(1, 6))
    assert do(Perform(MotionDefinition("nod", 1.0, {"HeadYaw": keys}))) == "done"
    assert robot.greatest_tilt < 5


def test_a_first_key_that_is_too_soon_comes_later(robot: SimulatedRobot, body: Body) -> None:
    """As on NAOqi: the words wait with the joints, and no joint misses its key."""
    robot.start("look", Look(-2.0, 0.0))
    until_answered(robot, "look")
    keys = (Keyframe(0.1, 2.0), Keyframe(1.0, 0.0))
    begun = robot.time
    robot.start("m", Perform(MotionDefinition("hasty", 1.0, {"HeadYaw": keys}, (Cue(0.1, "say", "now"),))))
    events = until_answered(robot, "m")
    assert [event.data for event in events if event.name == "done.command.m"] == [None]
    [cue] = [event for event in events if event.name == "cue"]
    assert cue.at - begun >= 4.0 / body.joints["HeadYaw"].speed
