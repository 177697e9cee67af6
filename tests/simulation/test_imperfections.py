"""What sensors and motors lack, and that each of it can be switched off."""

from dataclasses import replace

import numpy as np
import pytest

from lumen.language.robots import Body
from lumen.ports import Joints, Sense
from lumen.robots.simulation import SimulatedRobot
from lumen.robots.simulation.imperfections import EMPTY_VOLTAGE, NOMINAL_VOLTAGE, PERFECT, Imperfections, voltage
from lumen.robots.simulation.motor_torques import MotorTorques
from tests.simulation.conftest import MODELS


def robot(body: Body, lacking: Imperfections | None = None) -> SimulatedRobot:
    return SimulatedRobot(body, MODELS, "hall.xml", imperfections=lacking)


def angles(robot: SimulatedRobot) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    read = robot.read(Sense.JOINT)
    assert isinstance(read, Joints)
    return np.array(read.angles)


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


@pytest.mark.parametrize("latency", [0, 1, 3])
def test_a_command_acts_that_many_periods_later(body: Body, latency: int) -> None:
    late = robot(body, replace(PERFECT, latency=latency))
    late.advance(0.1)
    before, head = late.world.data.ctrl[0], late.motors.index["HeadYaw"]
    late.motors.goal[head] += 0.2
    late.advance(0.01 * latency)
    assert late.world.data.ctrl[0] == before
    late.advance(0.01)
    assert late.world.data.ctrl[0] > before


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


def test_the_battery_feeds_the_motors(body: Body) -> None:
    fed = robot(body)
    fed.condition._energy *= 0.5
    fed.advance(0.2)
    assert fed.motors.voltage == pytest.approx(voltage(0.5), abs=0.01)
