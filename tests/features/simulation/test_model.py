"""The MJCF agrees with the published robot, and nothing but its motors makes it stand."""

import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from lumen.features.simulation.model import load
from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look
from lumen.language.robots import Body
from tests.features.simulation.conftest import MODELS
from tests.features.simulation.published import JOINTS, LINKS, TOTAL_MASS

FINGERS = ("Fingers", "Thumb")


@pytest.fixture
def model(robot: SimulatedRobot) -> mujoco.MjModel:
    return robot.world.model


def rotation(axis: tuple[float, ...], angle: float) -> NDArray[np.float64]:
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def forward(angles: dict[str, float]) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return the place [m] and rotation of every link in the torso's frame, by the published chain."""
    poses = {"Torso": (np.zeros(3), np.eye(3))}
    for name, (parent, origin, axis, *_) in JOINTS.items():
        place, turn = poses[parent]
        poses[name] = place + turn @ np.array(origin), turn @ rotation(axis, angles[name])
    return poses


@pytest.mark.parametrize("seed", range(5))
def test_links_stand_where_the_published_chain_puts_them(robot: SimulatedRobot, seed: int) -> None:
    world, random = robot.world, np.random.default_rng(seed)
    angles = {name: random.uniform(low, high) for name, (_, _, _, low, high, _) in JOINTS.items()}
    angles["RHipYawPitch"] = angles["LHipYawPitch"]
    for name, angle in angles.items():
        world.data.joint(f"nao/{name}").qpos[0] = angle
    mujoco.mj_kinematics(world.model, world.data)
    torso = world.data.body("nao/Torso")
    for name, (place, turn) in forward(angles).items():
        link = world.data.body(f"nao/{name}")
        found = torso.xmat.reshape(3, 3).T @ (link.xpos - torso.xpos)
        assert found == pytest.approx(place, abs=1e-4), name
        assert torso.xmat.reshape(3, 3).T @ link.xmat.reshape(3, 3) == pytest.approx(turn, abs=1e-4), name


def test_joints_have_the_published_limits_and_torques(model: mujoco.MjModel, body: Body) -> None:
    for name, (_, _, _, low, high, effort) in JOINTS.items():
        assert tuple(model.joint(f"nao/{name}").range) == pytest.approx((low, high), abs=1e-6)
        assert (body.joints[name].minimum, body.joints[name].maximum) == pytest.approx((low, high))
        assert body.joints[name].effort == pytest.approx(effort)
        if name not in body.shared:
            assert tuple(model.actuator(f"nao/{name}").forcerange) == pytest.approx((-effort, effort))


def test_links_have_the_published_mass_and_inertia(model: mujoco.MjModel, robot: SimulatedRobot) -> None:
    for name, (mass, centre, (xx, yy, zz, xy, xz, yz)) in LINKS.items():
        parts = [f"nao/{name}"]
        if name.endswith("WristYaw"):
            parts += [f"nao/{name[0]}{digit}" for digit in FINGERS]
        found_mass, found_centre, found = composed(model, parts)
        assert found_mass == pytest.approx(mass, rel=1e-3)
        assert found_centre == pytest.approx(centre, abs=1e-5)
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert found == pytest.approx(inertia, abs=1e-7), name


def composed(model: mujoco.MjModel, parts: list[str]) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Return mass, centre and inertia of a link with the links that hang on it, in the link's frame, for joints at
    zero.
    """
    bodies = [model.body(part) for part in parts]
    places = [np.zeros(3), *(b.pos for b in bodies[1:])]
    masses = [float(b.mass[0]) for b in bodies]
    centres = [place + b.ipos for place, b in zip(places, bodies, strict=True)]
    middle = sum(m * c for m, c in zip(masses, centres, strict=True)) / sum(masses)
    inertia = np.zeros((3, 3))
    for b, m, c in zip(bodies, masses, centres, strict=True):
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, b.iquat)
        axes, arm = turn.reshape(3, 3), c - middle
        inertia += axes @ np.diag(b.inertia) @ axes.T + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return sum(masses), middle, inertia


def test_the_robot_weighs_what_was_published(model: mujoco.MjModel) -> None:
    assert model.body("nao/").subtreemass[0] == pytest.approx(TOTAL_MASS, rel=1e-4)


@pytest.mark.once
def test_a_heavier_brother_is_heavier_in_all_its_links(body: Body) -> None:
    worlds = [load(body, MODELS, "hall.xml", variation) for variation in (None, Variation(mass=1.1))]
    usual, heavy = ({link: world.find("body", f"nao/{link}").inertial for link in LINKS} for world in worlds)
    for link, inertial in heavy.items():
        assert inertial.mass == pytest.approx(1.1 * usual[link].mass), link
        assert inertial.fullinertia == pytest.approx(1.1 * usual[link].fullinertia), link


def test_nothing_helps_the_robot_to_stand(robot: SimulatedRobot) -> None:
    """The torso is free, gravity is real, and no weld and no outer force holds the robot."""
    model, data = robot.world.model, robot.world.data
    robot.advance(0.5)
    assert tuple(model.opt.gravity) == (0.0, 0.0, -9.81)
    assert model.opt.disableflags in (0, mujoco.mjtDisableBit.mjDSBL_ISLAND)
    assert model.joint("nao/").type[0] == mujoco.mjtJoint.mjJNT_FREE
    assert not model.body_gravcomp.any()
    assert set(map(int, model.eq_type)) == {int(mujoco.mjtEq.mjEQ_JOINT)}
    assert [model.body(i).name for i in range(model.nbody) if model.body_mocapid[i] >= 0] == ["visitor"]
    assert (model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT).all()
    assert model.joint("nao/").id not in model.actuator_trnid[:, 0]
    assert not data.xfrc_applied.any()
    assert not data.qfrc_applied.any()


def test_one_motor_turns_both_hip_yaw_pitch_joints(robot: SimulatedRobot, body: Body) -> None:
    names = {robot.world.model.actuator(i).name for i in range(robot.world.model.nu)}
    assert names == {f"nao/{name}" for name in body.joints if name != "RHipYawPitch"}
    robot.motors.aim({"RHipYawPitch": -0.3})
    robot.advance(1.0)
    angles = dict(zip(body.joints, robot.world.angles, strict=True))
    assert angles["LHipYawPitch"] == pytest.approx(-0.3, abs=0.02)
    assert angles["RHipYawPitch"] == pytest.approx(angles["LHipYawPitch"], abs=0.002)


def test_a_robot_of_the_same_files_is_a_copy_which_moves_alike_and_shares_nothing(body: Body, tmp_path: Path) -> None:
    models = Path(shutil.copytree(MODELS, tmp_path / "models"))
    compiled, copied = (SimulatedRobot(body, models, "hall.xml") for _ in range(2))
    for robot in (compiled, copied):
        robot.start("x", Look(0.5, 0.2))
        robot.advance(2.0)
    assert np.array_equal(compiled.world.data.qpos, copied.world.data.qpos)
    copied.world.model.opt.timestep = 0.5
    assert compiled.world.model.opt.timestep == 0.0025
    assert SimulatedRobot(body, models, "hall.xml").world.model.opt.timestep == 0.0025


def test_a_file_that_has_changed_makes_another_robot(body: Body, tmp_path: Path) -> None:
    models = Path(shutil.copytree(MODELS, tmp_path / "models"))
    assert SimulatedRobot(body, models, "hall.xml").world.model.opt.timestep == 0.0025
    hall = models / "hall.xml"
    hall.write_text(hall.read_text().replace('timestep="0.0025"', 'timestep="0.001"'))
    assert SimulatedRobot(body, models, "hall.xml").world.model.opt.timestep == 0.001
