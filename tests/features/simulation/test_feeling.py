"""The robot's internal sensors in NAOqi's names and units: soles, inertial unit, motor temperatures."""

from math import pi

import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Posture, Walk
from lumen.ports import Joints, Sense
from lumen.robot.recording import RecordingRobot
from lumen.robot.sense_codec import decode_reading, encode_reading
from tests.features.simulation.conftest import until_answered

WEIGHT = 5.30535


def felt(robot: SimulatedRobot) -> Joints:
    reading = robot.read(Sense.JOINT)
    assert isinstance(reading, Joints)
    return reading


def test_the_soles_feel_its_weight_and_where_it_rests(robot: SimulatedRobot) -> None:
    robot.advance(1.0)
    fsr = felt(robot).fsr
    assert len(fsr) == 10
    assert fsr["LFoot/FSR/TotalWeight"] + fsr["RFoot/FSR/TotalWeight"] == pytest.approx(WEIGHT, abs=0.02)
    assert fsr["LFoot/FSR/TotalWeight"] == pytest.approx(WEIGHT / 2, abs=0.3)
    for foot in ("LFoot", "RFoot"):
        corners = [fsr[f"{foot}/FSR/{end}{side}"] for end in ("Front", "Rear") for side in ("Left", "Right")]
        assert sum(corners) == pytest.approx(fsr[f"{foot}/FSR/TotalWeight"], abs=0.003)
        assert sorted(corners)[1] > 0, "a stiff sole rests on three corners at least"


def test_a_foot_in_the_air_feels_nothing_and_the_other_one_all(robot: SimulatedRobot) -> None:
    robot.start("w", Walk(0.2))
    least, greatest = 9.0, 0.0
    for _ in range(350):
        robot.advance(0.01)
        weight = felt(robot).fsr["LFoot/FSR/TotalWeight"]
        least, greatest = min(least, weight), max(greatest, weight)
    assert least == 0.0
    assert greatest > 0.9 * WEIGHT


def test_leaning_forward_moves_the_weight_to_the_toes(robot: SimulatedRobot) -> None:
    def toes() -> float:
        return sum(felt(robot).fsr[f"{side}Foot/FSR/Front{corner}"] for side in "LR" for corner in ("Left", "Right"))

    robot.advance(2.0)
    before, torso = toes(), robot.world.torso
    for _ in range(40):
        robot.world.data.xfrc_applied[torso][0] = 4.0
        robot.advance(0.01)
    assert toes() > before + 0.1
    assert felt(robot).inertial["AngleY"] > 0


def test_the_inertial_unit_at_rest_feels_up(robot: SimulatedRobot) -> None:
    robot.advance(1.0)
    inertial = felt(robot).inertial
    assert sorted({name[:-1] for name in inertial}) == ["Accelerometer", "Angle", "Gyroscope"]
    assert inertial["AccelerometerZ"] == pytest.approx(9.81, abs=0.05)
    assert abs(inertial["AngleX"]) < 0.01
    assert abs(inertial["AngleY"]) < 0.03
    assert abs(inertial["GyroscopeX"]) < 0.01


def test_the_inertial_unit_knows_how_far_it_has_turned(robot: SimulatedRobot) -> None:
    robot.start("w", Walk(0.0, 0.0, pi / 4))
    until_answered(robot, "w")
    assert felt(robot).inertial["AngleZ"] == pytest.approx(pi / 4, abs=0.06)


def test_motors_that_hold_get_warm(robot: SimulatedRobot) -> None:
    """The arms are held out in front for eight seconds."""
    robot.start("p", Posture("StandZero"))
    until_answered(robot, "p")
    robot.advance(8.0)
    joints = felt(robot)
    heat = dict(zip(joints.names, joints.temperature, strict=True))
    assert heat["LShoulderPitch"] > heat["LWristYaw"] >= 38.0


def test_it_crosses_the_bus_whole_and_robots_that_feel_nothing_say_nothing(robot: SimulatedRobot) -> None:
    joints = felt(robot)
    body = encode_reading(Sense.JOINT, joints)
    assert decode_reading(Sense.JOINT, body, joints.names) == joints
    plain = RecordingRobot(robot.body).read(Sense.JOINT)
    assert isinstance(plain, Joints)
    assert sorted(encode_reading(Sense.JOINT, plain)) == ["angle", "life", "name", "position", "stiffness", "time"]
    assert decode_reading(Sense.JOINT, encode_reading(Sense.JOINT, plain), plain.names) == plain


@pytest.mark.parametrize("broken", [{"fsr": 3}, {"inertial": {"AngleX": "much"}}, {"temperature": ["hot"]}])
def test_what_is_no_number_is_no_reading(robot: SimulatedRobot, broken: dict[str, object]) -> None:
    joints = felt(robot)
    assert decode_reading(Sense.JOINT, {**encode_reading(Sense.JOINT, joints), **broken}, joints.names) is None
