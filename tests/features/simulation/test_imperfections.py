"""The imperfections of sensors and motors, each of which has a switch."""

from dataclasses import fields, replace

import numpy as np
import pytest

from lumen.features.simulation.imperfections import BACKLASH, EMPTY_VOLTAGE, NOMINAL_VOLTAGE, voltage
from lumen.features.simulation.motors import MotorTorques
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.settings import IMPERFECTIONS, PERFECT, Imperfections, only
from lumen.language.robots import Body
from lumen.ports import Joints, Sense
from tests.features.simulation.conftest import MODELS


def robot(body: Body, lacking: Imperfections | None = None) -> SimulatedRobot:
    return SimulatedRobot(body, MODELS, "hall.xml", imperfections=lacking)


def angles(robot: SimulatedRobot) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    read = robot.read(Sense.JOINT)
    assert isinstance(read, Joints)
    return np.array(read.angles)


def rates(robot: SimulatedRobot, seconds: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Return the gyrometer's error in each control period [rad/s]; it reports the mean of the period before."""
    axes = robot.world.gyro_axes
    assert axes is not None
    wrong, before = [], axes.reshape(3, 3).copy()
    robot.advance(0.01)
    for _ in range(round(seconds / 0.01)):
        now = axes.reshape(3, 3).copy()
        t = before.T @ now
        really = np.array((t[2, 1] - t[1, 2], t[0, 2] - t[2, 0], t[1, 0] - t[0, 1])) / 0.02
        robot.advance(0.01)
        wrong.append(np.array((*robot._sensors.gyro, robot._sensors.turning)) - really)
        before = now
    return np.array(wrong)


def test_encoders_tell_whole_steps(body: Body) -> None:
    usual = robot(body)
    usual.advance(0.2)
    steps = angles(usual) / np.radians(0.1)
    assert steps == pytest.approx(np.round(steps), abs=1e-6)
    assert 0.0 < np.abs(angles(usual) - usual.world.angles).max() < 0.01


def test_who_looks_changes_nothing(body: Body) -> None:
    watched, alone = robot(body), robot(body)
    for _ in range(20):
        watched.advance(0.01)
        angles(watched)
    alone.advance(0.2)
    assert (watched.world.angles == alone.world.angles).all()


def test_a_perfect_robot_tells_the_truth(body: Body) -> None:
    perfect = robot(body, PERFECT)
    perfect.advance(0.2)
    before = perfect.world.angles
    perfect.advance(0.01)
    assert (angles(perfect) == before).all()
    assert np.abs(rates(perfect, 0.2)).max() < 0.0005


@pytest.mark.parametrize("name", IMPERFECTIONS)
def test_each_makes_a_difference_by_itself(body: Body, name: str) -> None:
    alone, perfect = robot(body, only((name,))), robot(body, PERFECT)
    for one in (alone, perfect):
        one.condition._energy *= 0.1
        one.advance(0.2)
        one.motors.aim({"LElbowRoll": -1.5, "LShoulderPitch": -1.0})
        one.motors.effort[:] *= 10.0
        one.motors._effort *= 10.0
        one.advance(0.3)
    differs = np.abs(angles(alone) - angles(perfect)).max(), abs(alone._sensors.turning - perfect._sensors.turning)
    assert max(differs) > 0.0


def test_the_switches_are_those_that_have_names() -> None:
    assert all(getattr(Imperfections(), field.name) is True for field in fields(Imperfections))
    assert only(IMPERFECTIONS) == Imperfections()


@pytest.mark.parametrize("latency", [False, True])
def test_a_command_acts_a_period_later(body: Body, latency: bool) -> None:
    late = robot(body, replace(PERFECT, latency=latency))
    late.advance(0.1)
    before, head = late.world.data.ctrl[0], late.motors.index["HeadYaw"]
    late.motors.goal[head] += 0.2
    late.advance(0.01 * latency)
    assert late.world.data.ctrl[0] == before
    late.advance(0.01)
    assert late.world.data.ctrl[0] > before


def test_a_joint_has_play_while_its_motor_stands_still(body: Body) -> None:
    loose = robot(body, only(("backlash",)))
    loose.advance(1.0)
    world, elbow = loose.world, loose.motors.index["LElbowRoll"]
    motor, link = [], []
    for push in (-0.2, 0.2):
        world.data.qfrc_applied[world.model.joint("nao/LElbowRollPlay").dofadr[0]] = push
        loose.advance(1.0)
        motor.append(world.data.qpos[world.model.joint("nao/LElbowRoll").qposadr[0]])
        link.append(world.angles[elbow])
    assert np.ptp(link) - np.ptp(motor) == pytest.approx(BACKLASH, rel=0.1)
    assert robot(body, PERFECT).world.model.njnt == world.model.njnt - len(body.joints) + len(body.hands)


def test_a_gyrometer_tells_a_turn_that_the_robot_has_learned(body: Body) -> None:
    wrong = rates(robot(body, only(("gyro_bias",))), 1.0)
    assert 0.0 < np.abs(wrong).max() < 0.003


def test_a_robot_that_stands_learns_how_it_changes(body: Body) -> None:
    """The robot gets warm in an hour: without learning, the heading would drift by a degree each second."""
    warm = robot(body, only(("gyro_bias",)))
    gyrometer = warm._sensors._gyrometer
    known, changed = gyrometer._calibration.bias, 20 * np.abs(gyrometer._drift).max()
    for _ in range(360_000):
        believed = gyrometer.feel((0.0, 0.0, 0.0), np.zeros(3), at_rest=True)
    assert np.abs(gyrometer._calibration.bias - known).max() == pytest.approx(changed, rel=0.1)
    assert np.abs(believed).max() < 0.0003


def test_it_learns_nothing_while_it_turns(body: Body) -> None:
    turned = robot(body, only(("gyro_bias",)))
    gyrometer = turned._sensors._gyrometer
    known = gyrometer._calibration.bias
    for k in range(1000):
        gyrometer.feel((0.0, 0.0, 0.5 * np.sin(k)), np.zeros(3), at_rest=True)
        gyrometer.feel((0.0, 0.0, 0.5), np.zeros(3), at_rest=False)
    assert (gyrometer._calibration.bias == known).all()


def test_torque_falls_with_speed_and_supply(body: Body) -> None:
    motors = robot(body)
    world = motors.world
    fastest = motors.motors.envelope.speed[world.driven]
    torques, allowed = MotorTorques(world, fastest), motors.motors.effort[world.driven, None] * (-1.0, 1.0)
    assert torques.limit(allowed, NOMINAL_VOLTAGE) == pytest.approx(allowed)
    world.data.qvel[world._speeds] = motors.motors.envelope.speed
    least, most = torques.limit(allowed, NOMINAL_VOLTAGE).T
    assert most == pytest.approx(0.0)
    assert least == pytest.approx(allowed[:, 0])
    world.data.qvel[world._speeds] *= 0.8
    nominal, low = (torques.limit(allowed, volts)[:, 1] for volts in (NOMINAL_VOLTAGE, EMPTY_VOLTAGE))
    assert (low < nominal).all()
    assert (nominal < allowed[:, 1]).all()
    assert MotorTorques(world, fastest, falling=False).limit(allowed, NOMINAL_VOLTAGE) == pytest.approx(allowed)


def test_the_battery_feeds_the_motors(body: Body) -> None:
    fed = robot(body)
    fed.condition._energy *= 0.5
    fed.advance(0.2)
    assert fed.motors.voltage == pytest.approx(voltage(0.5), abs=0.01)
