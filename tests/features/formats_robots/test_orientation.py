"""Rotations of imported models, compared with those that MuJoCo computes from the same attributes."""

from collections.abc import Mapping
from itertools import product
from random import Random

import mujoco
import numpy as np
import pytest

from lumen.features.formats_robots.orientation import AXES, Quaternion, Vector, between, of_axes

DRAW = Random(5)
DIRECTIONS: list[Vector] = [
    *((x, y, z) for x, y, z in product((-1.0, 0.0, 1.0), repeat=3) if x or y or z),
    *((DRAW.uniform(-2, 2), DRAW.uniform(-2, 2), DRAW.uniform(-2, 2)) for _ in range(20)),
]


def assert_as_in_mujoco(attribute: str, ours: Mapping[tuple[float, ...], Quaternion]) -> None:
    """Check the rotations (w, x, y, z) for values of the attribute; a quaternion and its negative are the same one."""
    bodies = [f'<body {attribute}="{" ".join(map(repr, said))}"><geom size="1"/></body>' for said in ours]
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(bodies)}</worldbody></mujoco>")
    for said, mine, theirs in zip(ours, ours.values(), model.body_quat[1:], strict=True):
        assert abs(float(np.dot(mine, theirs))) == pytest.approx(1.0, abs=1e-12), said


def test_the_z_axis_turns_in_each_direction_as_in_mujoco() -> None:
    assert_as_in_mujoco("zaxis", {z: between(AXES["z"], z) for z in DIRECTIONS})


def test_x_and_y_axes_turn_a_frame_as_in_mujoco() -> None:
    pairs = [(x, y) for x, y in product(DIRECTIONS, repeat=2) if np.linalg.norm(np.cross(x, y)) > 1e-3]
    assert_as_in_mujoco("xyaxes", {(*x, *y): of_axes(x, y) for x, y in pairs})
