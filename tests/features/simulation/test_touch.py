"""Touch: a knob in the hall presses the sensor that it touches, and no other."""

from pathlib import Path

import numpy as np
import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.robots import Body
from tests.features.simulation.conftest import MODELS

RADIUS = 0.02
DEPTH = 0.003
"""The overlap between the knob and the part that touches it [m]."""

TOUCHED = {
    "ChestButton": ("Torso", (1, 0, 0), (0.052, 0.0, 0.0552)),
    "FrontTactil": ("HeadPitch", (0.5, 0, 0.866), (0.0265, 0.0, 0.101)),
    "MiddleTactil": ("HeadPitch", (0, 0, 1), (0.0, 0.0, 0.108)),
    "RearTactil": ("HeadPitch", (-0.5, 0, 0.866), (-0.0265, 0.0, 0.101)),
    "HandLeftBack": ("LWristYaw", (0, 0, 1), (0.05, 0.0, 0.022)),
    "HandLeftLeft": ("LWristYaw", (0, 1, 0), (0.05, 0.022, 0.0)),
    "HandLeftRight": ("LWristYaw", (0, -1, 0), (0.05, -0.022, 0.0)),
    "HandRightBack": ("RWristYaw", (0, 0, 1), (0.05, 0.0, 0.022)),
    "HandRightLeft": ("RWristYaw", (0, 1, 0), (0.05, 0.022, 0.0)),
    "HandRightRight": ("RWristYaw", (0, -1, 0), (0.05, -0.022, 0.0)),
    "LeftBumper": ("LAnkleRoll", (1, 0, 0), (0.095, 0.009, -0.03)),
    "RightBumper": ("RAnkleRoll", (1, 0, 0), (0.095, -0.009, -0.03)),
}
"""For each sensor: its link, the direction out of the shell there, and a point of the shell [m]."""


@pytest.mark.parametrize("sensor", TOUCHED)
def test_what_stands_there_presses_the_sensor_it_touches(body: Body, tmp_path: Path, sensor: str) -> None:
    link, out, point = TOUCHED[sensor]
    free = SimulatedRobot(body, MODELS)
    frame = free.world.data.body(f"nao/{link}")
    centre = frame.xpos + frame.xmat.reshape(3, 3) @ (np.array(point) + np.array(out) * (RADIUS - DEPTH))
    knob = f'<geom class="solid" type="sphere" size="{RADIUS}" pos="{" ".join(f"{x:.5f}" for x in centre)}"/>'
    (tmp_path / "hall").symlink_to(MODELS / "hall")
    hall = (MODELS / "hall.xml").read_text("utf-8").replace('<body name="desk"', f'{knob}<body name="desk"')
    (tmp_path / "knob.xml").write_text(hall, "utf-8")
    robot = SimulatedRobot(body, MODELS, str(tmp_path / "knob.xml"))
    robot.advance(0.01)
    felt = [(e.name, e.data["sensor"]) for e in robot.poll() if e.name in {"touched", "released"}]
    assert felt == [("touched", sensor)]


def test_each_sensor_has_its_place(body: Body) -> None:
    assert set(TOUCHED) == set(body.tactile)
