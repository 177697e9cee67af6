"""Rotations of imported models, compared with those that MuJoCo computes from the same attributes."""

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


def of_mujoco(attribute: str, *numbers: float) -> Quaternion:
    """Return the rotation (w, x, y, z) of a body with this attribute."""
    body = f'<body {attribute}="{" ".join(map(repr, numbers))}"><geom size="1"/></body>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    w, x, y, z = map(float, model.body_quat[1])
    return w, x, y, z


def assert_same(ours: Quaternion, theirs: Quaternion) -> None:
    """Check that two quaternions are the same rotation: a quaternion and its negative are."""
    assert abs(float(np.dot(ours, theirs))) == pytest.approx(1.0, abs=1e-12)


def test_the_z_axis_turns_in_each_direction_as_in_mujoco() -> None:
    for z in DIRECTIONS:
        assert_same(between(AXES["z"], z), of_mujoco("zaxis", *z))


def test_x_and_y_axes_turn_a_frame_as_in_mujoco() -> None:
    for x, y in product(DIRECTIONS, repeat=2):
        if np.linalg.norm(np.cross(x, y)) > 1e-3:
            assert_same(of_axes(x, y), of_mujoco("xyaxes", *x, *y))
