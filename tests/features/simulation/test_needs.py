"""Models that the simulation can't use: one error that lists all that is missing, never a traceback."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumen.errors import RobotError
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.robots import Body
from tests.features.simulation.conftest import MODELS


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(shutil.copytree(MODELS, tmp_path_factory.mktemp("project") / "models"))


def changed(models: Path, file: str, *edits: tuple[str, str]) -> str:
    """Write a copy of a model with these edits, and return its name."""
    text = (models / file).read_text()
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (models / f"other_{file}").write_text(text)
    return f"other_{file}"


def trouble(body: Body, models: Path, hall: str = "hall.xml") -> str:
    with pytest.raises(RobotError) as raised:
        SimulatedRobot(body, models, hall)
    return str(raised.value)


def test_a_robot_without_camera_and_sole_is_told_both(body: Body, models: Path) -> None:
    mjcf = changed(models, "nao.xml", ("CameraTop", "CameraFront"), ('"LSole"', '"LeftSole"'))
    reason = trouble(replace(body, mjcf=mjcf), models)
    assert reason.startswith("other_nao.xml lacks what the simulation needs: ")
    assert "the camera `CameraTop`" in reason
    assert "the site `LSole`" in reason


def test_a_hall_without_stage_and_visitor_is_told_both(body: Body, models: Path) -> None:
    hall = changed(models, "hall.xml", ('name="visitor"', 'name="guest"'), ('name="stage"', 'name="floor"'))
    reason = trouble(body, models, hall)
    assert "other_hall.xml lacks what the simulation needs: the site `stage`, the body `visitor`" in reason


def test_a_visitor_who_can_not_be_moved_is_told(body: Body, models: Path) -> None:
    hall = changed(models, "hall.xml", ('name="visitor" mocap="true"', 'name="visitor"'))
    assert 'mocap="true"' in trouble(body, models, hall)


@pytest.mark.parametrize("edit", [("</mujoco>", ""), ('type="ellipsoid" size="0.118 0.16 0.3"', 'type="ellipsoid"')])
def test_a_broken_hall_is_told(body: Body, models: Path, edit: tuple[str, str]) -> None:
    assert "hall" in trouble(body, models, changed(models, "hall.xml", edit))


def test_a_body_without_postures_and_joints_is_told_what_it_lacks(body: Body, models: Path) -> None:
    postures = {name: angles for name, angles in body.postures.items() if name != "Stand"}
    joints = {name: joint for name, joint in body.joints.items() if name != "HeadYaw"}
    reason = trouble(replace(body, postures=postures, joints=joints), models)
    assert "the joint `HeadYaw`, the posture `Stand`" in reason


@pytest.mark.parametrize("timestep", ["0.05", "0.000000001", "-0.002", "nan"])
def test_a_timestep_that_no_simulation_can_live_with_is_told(body: Body, models: Path, timestep: str) -> None:
    hall = changed(models, "hall.xml", ('timestep="0.0025"', f'timestep="{timestep}"'))
    assert "a timestep from 0.0001 to 0.01 s" in trouble(body, models, hall)


def test_a_timestep_that_would_lose_time_is_told(body: Body, models: Path) -> None:
    hall = changed(models, "hall.xml", ('timestep="0.0025"', 'timestep="0.003"'))
    assert "a timestep that divides 0.01 s evenly" in trouble(body, models, hall)


def test_what_stands_nowhere_is_told_by_its_name(body: Body, models: Path) -> None:
    hall = changed(models, "hall.xml", ('pos="0 0 0.25"', 'pos="0 0 nan"'))
    assert "a position that is not a number: podium" in trouble(body, models, hall)


@pytest.mark.parametrize(("file", "content"), [("nao/head.obj", "v 1 2 x"), ("hall/planks.png", "no picture")])
def test_a_broken_mesh_or_texture_is_told_by_its_own_name(
    body: Body, models: Path, tmp_path: Path, file: str, content: str
) -> None:
    broken = Path(shutil.copytree(models, tmp_path / "models"))
    (broken / file).write_text(content)
    reason = trouble(body, broken)
    assert Path(file).name in reason
    assert "pymjcf_debug" not in reason


def test_a_simulation_that_has_become_unstable_ends_instead_of_beginning_anew(robot: SimulatedRobot) -> None:
    robot.world.data.qvel[:] = np.nan
    with pytest.raises(RobotError, match="unstable"):
        robot.advance(0.2)


def test_a_hall_in_degrees_is_told(body: Body, models: Path) -> None:
    hall = changed(models, "hall.xml", ('angle="radian"', 'angle="degree"'))
    assert "other_hall.xml does not fit the robot's nao.xml" in trouble(body, models, hall)
