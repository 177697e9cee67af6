"""The positions of points in NAO's top camera, and the head pose that centres them."""

from math import radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.robots import Camera
from lumen.motion.projection import camera_pose, centring, into_camera, project, seen

TOP = Camera(320, 240, radians(60.97), radians(47.64), (0.05871, 0.0, 0.06364), 0.0209)


def test_a_point_straight_ahead_of_the_lens_is_in_the_middle() -> None:
    assert project((1.0, 0.0, 0.0), TOP) == pytest.approx((160.0, 120.0))


def test_left_is_left_and_up_is_up() -> None:
    u, v = project((1.0, 0.1, 0.1), TOP) or (0.0, 0.0)
    assert u < 160
    assert v < 120


def test_the_edges_are_the_angles_of_view() -> None:
    assert project((1.0, -0.588, 0.0), TOP) is not None
    assert project((1.0, -0.590, 0.0), TOP) is None
    assert project((1.0, 0.0, 0.442), TOP) is None
    assert project((-1.0, 0.0, 0.0), TOP) is None


def test_a_camera_at_rest_stands_where_the_data_sheet_says() -> None:
    place, rotation = camera_pose(TOP, 0.0, 0.0)
    assert place == pytest.approx((0.05871, 0.0, 0.1265 + 0.06364))
    assert [row[0] for row in rotation] == pytest.approx([0.99978, 0.0, -0.0209], abs=1e-5)


def test_yaw_turns_left_and_pitch_turns_down() -> None:
    (_, left, _), _ = camera_pose(TOP, 0.5, 0.0)
    assert left > 0
    (_, _, high), _ = camera_pose(TOP, 0.0, -0.5)
    (_, _, low), _ = camera_pose(TOP, 0.0, 0.5)
    assert high > low


@given(st.floats(0.4, 5), st.floats(-4, 4), st.floats(-1, 1.5))
def test_the_centring_head_centres(x: float, y: float, z: float) -> None:
    yaw, pitch = centring((x, y, z), TOP)
    assert seen((x, y, z), TOP, yaw, pitch) == pytest.approx((160, 120), abs=1e-6)


@given(st.floats(-2, 2), st.floats(-0.6, 0.5))
def test_a_rotation_keeps_distances(yaw: float, pitch: float) -> None:
    place, _ = camera_pose(TOP, yaw, pitch)
    x, y, z = into_camera((1.0, 0.2, 0.3), TOP, yaw, pitch)
    expected = sum((a - b) ** 2 for a, b in zip((1.0, 0.2, 0.3), place, strict=True))
    assert x * x + y * y + z * z == pytest.approx(expected)
