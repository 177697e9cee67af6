"""`motors: {give: …}`: joints of others' models, which are driven by torques or by nothing, become servos."""

import numpy as np
import pytest
from dm_control import mjcf

from lumen.features.simulation.model import add_servos
from lumen.language.robots import Body, Joint

MODEL = """
<mujoco>
  <worldbody>
    <body name="a">
      <joint name="shoulder" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03" mass="1"/>
      <body name="b" pos="0.3 0 0">
        <joint name="elbow" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.2 0 0" size="0.03" mass="0.5"/>
        <body name="c" pos="0.2 0 0"><joint name="wrist" axis="0 1 0"/><geom size="0.03" mass="0.2"/></body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="shoulder" joint="shoulder" gear="80"/>
    <position name="elbow" joint="elbow" kp="7"/>
  </actuator>
</mujoco>
"""
EFFORTS = {"shoulder": 20.0, "elbow": 9.0, "wrist": 3.0}


def body(give: float) -> Body:
    joints = {name: Joint(name, -1.0, 1.0, 4.0, effort) for name, effort in EFFORTS.items()}
    return Body("arm", "arm.xml", joints, {}, {}, (), None, (), give=give)


def served(give: float) -> mjcf.RootElement:
    robot = mjcf.from_xml_string(MODEL)
    add_servos(robot, body(give))
    return robot


def test_only_joints_without_a_servo_of_their_name_get_one() -> None:
    motors = {motor.name: motor for motor in served(0.1).find_all("actuator")}
    assert {name: motor.tag for name, motor in motors.items()} == dict.fromkeys(EFFORTS, "position")
    assert {name: motor.kp for name, motor in motors.items()} == {"shoulder": 200.0, "elbow": 7.0, "wrist": 30.0}
    assert list(motors["wrist"].forcerange) == [-3.0, 3.0]


def test_nothing_is_added_where_nobody_asked() -> None:
    assert [motor.tag for motor in served(0.0).find_all("actuator")] == ["motor", "position"]


def test_an_arm_that_had_torques_goes_where_it_is_told_and_stays() -> None:
    robot = served(0.1)
    robot.find("actuator", "elbow").remove()
    add_servos(robot, body(0.1))
    physics = mjcf.Physics.from_mjcf_model(robot)
    motors = robot.find_all("actuator")
    reached = []
    while physics.time() < 4.0:
        on_the_way = min(1.0, physics.time())
        physics.bind(motors).ctrl = [on_the_way * (0.5 if motor.name == "shoulder" else 0.2) for motor in motors]
        physics.step()
        reached.append(float(physics.bind(robot.find("joint", "shoulder")).qpos[0]))
    load = 9.81 * (1 * 0.15 + 0.5 * 0.4 + 0.2 * 0.5) / EFFORTS["shoulder"]
    assert reached[-1] == pytest.approx(0.5 + 0.1 * load, abs=0.02)
    assert np.ptp(reached[-200:]) < 1e-3
    assert max(reached) < 0.5 + 0.1, "it does not swing"
