"""Senses and the world around: visitor, face, sonar, touch, battery, heat."""

from pathlib import Path

import numpy as np
import pytest

from lumen.errors import UsageError
from lumen.features.simulation.battery_and_heat import BatteryAndHeat
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look, Say, Wake, Walk
from lumen.language.robots import Body
from lumen.language.stories import Visitor
from lumen.ports import Battery, Joints, Sense, Sonar, Tactile
from tests.features.simulation.conftest import MODELS, Do, answer, look_at_face, until_answered


@pytest.mark.parametrize("visitor", [Visitor(), Visitor(1.5, 0.5), Visitor(1.2, -0.4, 1.1)])
def test_who_looks_at_the_visitor_has_their_face_in_the_middle(
    robot: SimulatedRobot, do: Do, body: Body, visitor: Visitor
) -> None:
    robot.place(visitor)
    look_at_face(robot, do, body)
    assert robot.face() == pytest.approx((160, 120), abs=8)  # its neck has play


def test_a_face_moves_as_the_camera_turns(robot: SimulatedRobot, do: Do, body: Body) -> None:
    robot.place(Visitor())
    look_at_face(robot, do, body)
    yaw, pitch = (float(robot.world.angles[i]) for i in (0, 1))
    do(Look(yaw + 0.2, pitch + 0.1))
    robot.advance(0.5)
    x, y = robot.face() or (0, 0)
    assert x > 190  # the head turned left, the face is on the right
    assert y < 105  # the head went down, the face went up
    do(Look(yaw - 1.5, pitch))
    robot.advance(0.5)
    assert robot.face() is None


def test_nobody_has_no_face(robot: SimulatedRobot) -> None:
    assert robot.face() is None
    robot.place(Visitor())
    robot.place(None)
    assert robot.face() is None


def test_the_sonars_hear_the_visitor(robot: SimulatedRobot) -> None:
    robot.advance(0.1)
    silent = robot.read(Sense.SONAR)
    robot.place(Visitor(1.0, 0.0))
    robot.advance(0.1)
    near = robot.read(Sense.SONAR)
    robot.place(Visitor(0.8, 0.5))
    robot.advance(0.1)
    aside = robot.read(Sense.SONAR)
    assert isinstance(silent, Sonar)
    assert isinstance(near, Sonar)
    assert isinstance(aside, Sonar)
    assert min(silent.left, silent.right) > 2.0
    assert (near.left, near.right) == pytest.approx((0.83, 0.83), abs=0.1)
    assert aside.left < 0.9 < aside.right


def test_joints_are_read_in_naoqi_s_order(robot: SimulatedRobot, body: Body) -> None:
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.names == tuple(body.joints)
    assert joints.angles[joints.names.index("LKneePitch")] == pytest.approx(-0.0923, abs=1e-3)
    assert set(joints.stiffness) == {1.0}


def test_touch_is_an_event_and_a_reading(robot: SimulatedRobot, body: Body) -> None:
    robot.touch("MiddleTactil", True)
    robot.touch("MiddleTactil", True)
    tactile = robot.read(Sense.TACTILE)
    assert isinstance(tactile, Tactile)
    assert tactile.names == body.tactile
    assert [n for n, v in zip(tactile.names, tactile.values, strict=True) if v] == ["MiddleTactil"]
    robot.touch("MiddleTactil", False)
    assert [(e.name, e.data) for e in robot.poll()] == [
        ("touched", {"sensor": "MiddleTactil"}),
        ("released", {"sensor": "MiddleTactil"}),
    ]
    with pytest.raises(UsageError, match="did you mean `MiddleTactil`"):
        robot.touch("MidleTactil", True)


def test_the_battery_drains_slowly(robot: SimulatedRobot) -> None:
    robot.advance(5.0)
    battery = robot.read(Sense.BATTERY)
    assert isinstance(battery, Battery)
    assert battery.percentage == 100
    assert not battery.plugged


def test_a_low_battery_and_hot_motors_speak_up_once() -> None:
    condition = BatteryAndHeat(("knee", "hip"), (3.0, 3.0), charge=0.206)
    events = [e for t in range(1200) for e in condition.live(np.array([3.0, 0.0]), np.zeros(2), 1.0, float(t))]
    assert [e.name for e in events] == ["battery.low", "motors.hot"]
    assert events[0].data == {"percentage": 20}
    assert events[1].data["joint"] == "knee"
    assert events[1].data["temperature"] >= 75.0


def test_a_charger_fills_the_battery_and_it_may_speak_up_again() -> None:
    condition, torques = BatteryAndHeat(("knee",), (3.0,), charge=0.206), np.zeros(1)

    def live(seconds: int) -> list[str]:
        return [e.name for t in range(seconds) for e in condition.live(torques, torques, 1.0, float(t))]

    assert live(300) == ["battery.low"]
    condition.plugged = True
    assert live(600) == []
    assert condition.charging
    assert condition.percentage > 30
    condition.plugged = False
    assert live(1500) == ["battery.low"]
    condition.plugged = True
    assert live(4000) == ["battery.full"]
    assert condition.percentage == 100
    assert not condition.charging


def test_an_empty_battery_lets_the_robot_rest_until_it_is_plugged_in(robot: SimulatedRobot, do: Do) -> None:
    robot.condition = BatteryAndHeat(
        tuple(robot.body.joints), [j.effort for j in robot.body.joints.values()], charge=3e-5
    )
    robot.start("say", Say("x" * 2000))
    events = until_answered(robot, "say")
    assert answer(events, "say") == "cancelled"
    assert do(Wake()) == "error: the battery is empty: plug the robot in"
    robot.advance(3.0)
    assert not robot.awake
    assert not robot.fallen
    assert robot.motors.stiffness.max() == 0.0
    assert robot.world.tilt < 0.5
    assert not any("battery" in event.name and "command" in event.name for event in robot.poll())
    robot.plug(True)
    robot.advance(1.0)
    assert do(Wake()) == "done"


def test_what_a_foot_runs_into_presses_its_bumper_and_ends_the_walk(body: Body, tmp_path: Path) -> None:
    (tmp_path / "hall").symlink_to(MODELS / "hall")
    ledge = '<geom class="solid" type="box" size="0.02 0.4 0.02" pos="0.22 0 0.52" material="wood"/>'
    hall = (MODELS / "hall.xml").read_text("utf-8").replace('<body name="desk"', f'{ledge}<body name="desk"')
    (tmp_path / "ledge.xml").write_text(hall, "utf-8")
    robot = SimulatedRobot(body, MODELS, str(tmp_path / "ledge.xml"))
    robot.start("w", Walk(0.3))
    events = until_answered(robot, "w")
    assert {event.data["sensor"] for event in events if event.name == "touched"} & {"LeftBumper", "RightBumper"}
    assert "bumper is pressed" in answer(events, "w")
    assert robot.greatest_tilt < 30
