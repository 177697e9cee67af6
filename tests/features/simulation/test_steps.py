"""A control period's steps of MuJoCo: what they leave out changes nothing."""

import mujoco
import numpy as np

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Walk
from lumen.language.robots import Body
from tests.features.simulation.conftest import MODELS

ISLANDS = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)


def test_a_robot_alone_lives_as_one_whose_islands_are_looked_for(body: Body) -> None:
    one, other = (SimulatedRobot(body, MODELS) for _ in range(2))
    assert one.world.model.opt.disableflags & ISLANDS
    other.world.model.opt.disableflags &= ~ISLANDS
    for robot in (one, other):
        robot.start("it", Walk(0.1))
        robot.advance(1.0)
    assert np.array_equal(one.world.data.qpos, other.world.data.qpos)
