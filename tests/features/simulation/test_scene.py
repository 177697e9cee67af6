"""models/scene.xml, opened as those of mujoco_menagerie are: it compiles, moves without a warning, and stands."""

import mujoco
import numpy as np
import pytest
from dm_control import mjcf
from scripts.scene import POSTURES, scene

import lumen
from lumen.features.simulation.model import alone
from tests import ROOT

MODELS = ROOT / "models"
MOVED, STOOD = 1.1, 2.0
"""The duration of random motion, and the duration for which the robot must stand [s]."""


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_path(str(MODELS / "scene.xml"))


def test_it_is_what_the_script_makes_of_the_body() -> None:
    assert (MODELS / "scene.xml").read_text("utf-8") == scene(MODELS)


def test_it_is_the_whole_robot(model: mujoco.MjModel) -> None:
    robot = mjcf.Physics.from_mjcf_model(alone(lumen.load(ROOT).body, MODELS)).model
    for count in ("nu", "ncam", "neq", "nexclude", "nsensor", "nmesh", "nlight"):
        assert getattr(model, count) >= getattr(robot, count), count
    assert (model.njnt, model.neq, model.nexclude) == (robot.njnt + 1, robot.neq, robot.nexclude)
    assert sum(model.body_mass) == pytest.approx(sum(robot.body_mass))


def test_any_command_moves_it_without_a_warning(model: mujoco.MjModel) -> None:
    data, draw = mujoco.MjData(model), np.random.default_rng(0)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    low, high = model.actuator_ctrlrange.T
    while data.time < MOVED:
        if round(data.time / model.opt.timestep) % 50 == 0:
            data.ctrl[:] = draw.uniform(low, high)
        mujoco.mj_step(model, data)
    assert not data.warning.number.any()
    assert np.isfinite(data.qpos).all()


@pytest.mark.parametrize("posture", POSTURES)
def test_a_keyframe_stands(model: mujoco.MjModel, posture: str) -> None:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(posture).id)
    height = data.qpos[2]
    while data.time < STOOD:
        mujoco.mj_step(model, data)
    assert data.xmat[model.body("nao").id][-1] > 0.98
    assert data.qpos[2] == pytest.approx(height, abs=0.02)
