"""The head follows a face: by its pose at capture, within every limit; it searches for a lost face."""

from dataclasses import replace
from math import degrees, hypot, pi, radians
from typing import Any
from unittest.mock import Mock

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.bus.memory import MemoryBus
from lumen.fuzzy import Controller
from lumen.language.commands import Track
from lumen.motion.limits import coupled_range
from lumen.motion.projection import Vector3, centring, seen
from lumen.motion.tracking import Tracker
from lumen.ports import Aim
from lumen.run.tracking import LocalTracking
from tests import exhibits
from tests.fuzzy.closed_loop import off_by, run
from tests.fuzzy.nao import COUPLED, HEAD, TOP
from tests.tables import for_each

HERE = {"HeadYaw": 0.0, "HeadPitch": 0.0}
ADULT: Vector3 = (1.5, 0.2, 0.5)


@pytest.fixture(scope="module")
def head() -> Controller:
    return Controller.load("fuzzy/head.yaml")


@pytest.fixture
def plain(head: Controller) -> Tracker:
    """A tracker with the rules alone: one look, no magnification."""
    return Tracker(replace(head, tracking=replace(head.tracking, looks=1, zoom=1.0)), HEAD)


def test_a_face_on_the_left_turns_the_head_left_and_one_above_raises_it(plain: Tracker) -> None:
    plain.pose(1.0, HERE)
    target = plain.see({"x": 0, "y": 0}, 1.0)
    assert target == pytest.approx({"HeadYaw": radians(1.5 * 7.0884), "HeadPitch": -radians(1.5 * 2.4378)}, abs=1e-5)


def test_a_controller_reads_its_messages_from_the_start(head: Controller) -> None:
    started: list[Any] = []
    bus, robot = MemoryBus(), Mock(start=lambda _, command: started.append(command))
    tracking = LocalTracking(exhibits.project(controllers={"head": head}), robot, bus)
    tracking.switch(Track("head"))
    bus.publish("avatar.NAO.data.joint", {"name": [*HERE], "angle": [*HERE.values()], "time": 1.0})
    bus.publish("lumen.visual.face.detection", {"x": 0, "y": 120, "time": 1.0})
    tracking.tick(1.0)
    (aim,) = started
    assert isinstance(aim, Aim)
    assert aim.angles["HeadYaw"] > 0.0


def test_the_turn_counts_from_the_pose_at_capture(plain: Tracker) -> None:
    plain.pose(1.0, {"HeadYaw": 0.1, "HeadPitch": 0.0})
    plain.pose(1.1, {"HeadYaw": 0.3, "HeadPitch": 0.0})
    target = plain.see({"x": 80, "y": 120}, 1.05)
    assert target is not None
    assert target["HeadYaw"] == pytest.approx(0.2 + radians(1.5 * 2.8431), abs=1e-5)


def test_a_sight_without_use_moves_nothing(plain: Tracker) -> None:
    assert plain.see({"x": 80, "y": 120}, 1.0) is None, "no pose yet"
    plain.pose(10.0, HERE)
    assert plain.see({"x": 80, "y": 120}, 8.9) is None, "older than `stale`"
    assert plain.see({"x": 80}, 10.0) is None, "a field is missing"
    assert plain.see({"x": 80, "y": "120"}, 10.0) is None, "a text is not a number"
    assert plain.see({"x": 80, "y": float("nan")}, 10.0) is None
    assert plain.see({"x": 80, "y": 120}, 10.0) is not None
    assert plain.see({"x": 80, "y": 120}, 9.9) is None, "older than the one before"


@pytest.mark.parametrize("time", [1754000000, 1e12, 10.2, 10**400, float("inf"), float("nan"), True])
def test_a_message_from_the_future_changes_nothing(plain: Tracker, time: float) -> None:
    plain.pose(time, HERE, now=10.0)
    plain.pose(10.0, HERE, now=10.0)
    assert plain.see({"x": 80, "y": 120}, time, now=10.0) is None
    assert plain.see({"x": 80, "y": 120}, 10.0, now=10.0) is not None
    plain.pose(10.5, {"HeadYaw": 0.3, "HeadPitch": 0.0}, now=10.5)
    target = plain.see({"x": 160, "y": 120}, 10.55, now=10.5)
    assert target == pytest.approx({"HeadYaw": 0.3, "HeadPitch": 0.0}, abs=1e-9), "clocks differ a little"


def test_an_integer_beyond_all_floats_is_no_number(plain: Tracker) -> None:
    plain.pose(10.0, HERE | {"HeadYaw": 10**400})
    assert plain.see({"x": 80, "y": 120}, 10.0) is None, "no pose"
    plain.pose(10.0, HERE)
    assert plain.see({"x": 10**400, "y": 120}, 10.0) is None


@pytest.mark.slow
@given(st.floats(-2.1, 2.1), st.floats(-0.7, 0.6), st.integers(0, 319), st.integers(0, 239))
def test_every_limit_holds(yaw: float, pitch: float, x: int, y: int) -> None:
    tracker = Tracker(CONTROLLER, HEAD)
    tracker.pose(0.0, {"HeadYaw": yaw, "HeadPitch": pitch})
    target = tracker.see({"x": x, "y": y}, 0.0)
    assert target is not None
    assert abs(target["HeadYaw"]) <= radians(60) + 1e-12
    low, high = coupled_range(COUPLED, target["HeadYaw"])
    assert max(low, HEAD.joints["HeadPitch"].minimum) - 1e-12 <= target["HeadPitch"]
    assert target["HeadPitch"] <= min(high, HEAD.joints["HeadPitch"].maximum) + 1e-12


CONTROLLER = Controller.load("fuzzy/head.yaml")


@for_each("latency", [0.0, 0.1, 0.2])
@for_each("tick", [0.033, 0.1])
@for_each(("yaw", "pitch"), [(15, 8), (-15, -8), (15, -8), (-15, 8)])
def test_the_loop_settles_without_overshoot(
    head: Controller, latency: float, tick: float, yaw: float, pitch: float
) -> None:
    goal = centring(ADULT, TOP)
    outcome = run(head, lambda now: ADULT, off_by(ADULT, yaw, pitch), latency=latency, tick=tick)
    for axis in (0, 1):
        assert outcome.overshoot(axis, goal[axis]) <= 0.10
        assert outcome.settled(axis, goal[axis]) <= 2.5


@for_each("face", [(1.5, 0.0, 0.9), (1.5, 0.6, 0.3), (2.5, -1.0, 0.9), (0.8, 0.3, 0.2), (3.0, 0.0, 1.0)])
@for_each("latency", [0.0, 0.2])
def test_a_face_within_reach_ends_within_ten_pixels_of_the_centre(
    head: Controller, face: Vector3, latency: float
) -> None:
    outcome = run(head, lambda now: face, off_by(face, 12, 6), latency=latency, tick=0.1, duration=5.0)
    u, v = outcome.pixels[-1] or (0.0, 0.0)
    assert hypot(u - 160, v - 120) <= 10


def test_without_magnification_the_head_rests_beside_the_face(head: Controller) -> None:
    flat = replace(head, tracking=replace(head.tracking, zoom=1.0))
    outcome = run(flat, lambda now: ADULT, off_by(ADULT, 15, 0), duration=5.0)
    u, _ = outcome.pixels[-1] or (160.0, 0.0)
    assert abs(u - 160) > 40


@for_each("latency", [0.1, 0.2])
@for_each("tick", [0.033, 0.1])
@for_each("error", [-0.05, 0.05])
def test_a_capture_time_that_is_50_ms_wrong_does_not_shake_the_head(
    head: Controller, latency: float, tick: float, error: float
) -> None:
    goal = centring(ADULT, TOP)
    outcome = run(head, lambda now: ADULT, off_by(ADULT, 15, 8), latency=latency, tick=tick, error=error, duration=6.0)
    for axis in (0, 1):
        assert outcome.overshoot(axis, goal[axis]) <= 0.10
        assert abs(outcome.poses[-1][1 + axis] - goal[axis]) <= radians(1)


def test_a_walking_visitor_stays_in_the_image(head: Controller) -> None:
    def walking(now: float) -> Vector3:
        return 1.5, -1.0 + 0.5 * now, 0.5

    start = centring(walking(0.0), TOP)
    outcome = run(head, walking, start, latency=0.2, tick=0.1, duration=4.0)
    assert None not in outcome.pixels
    assert max(abs(pixel[0] - 160) for pixel in outcome.pixels if pixel) < 120


def test_a_head_at_its_limit_rests(head: Controller) -> None:
    tall: Vector3 = (1.0, 0.0, 1.1)
    outcome = run(head, lambda now: tall, (0.0, radians(-30)), latency=0.1, tick=0.033, duration=3.0)
    late = [pose[2] for pose in outcome.poses if pose[0] > 2.0]
    assert min(late) == max(late) == pytest.approx(radians(-38.5), abs=1e-5)


@for_each("latency", [0.0, 0.1, 0.2])
@for_each("tick", [0.033, 0.1])
@for_each("sag", [-0.6, 0.6])
def test_a_head_that_hangs_below_what_it_was_told_looks_at_the_face_all_the_same(
    head: Controller, latency: float, tick: float, sag: float
) -> None:
    goal = centring(ADULT, TOP)
    hanging = (radians(sag / 3), radians(sag))
    outcome = run(head, lambda now: ADULT, off_by(ADULT, 15, 8), latency=latency, tick=tick, sag=hanging, duration=5.0)
    for axis in (0, 1):
        assert outcome.settled(axis, goal[axis]) <= 4.0


def test_a_head_that_something_holds_is_not_pushed_further(plain: Tracker) -> None:
    for i in range(10):
        plain.pose(1.0 + 0.1 * i, {"HeadYaw": -0.3, "HeadPitch": 0.0})
        target = plain.see({"x": 0, "y": 120}, 1.0 + 0.1 * i)
    assert target is not None
    assert target["HeadYaw"] == pytest.approx(-0.3 + radians(1.5 * 7.0884), abs=1e-5)


def test_lost_it_holds_then_searches_then_looks_ahead(head: Controller) -> None:
    tracker, times = Tracker(head, HEAD), head.tracking
    tracker.pose(10.0, HERE)
    seen_at = tracker.see({"x": 40, "y": 120}, 10.0)
    assert seen_at is not None
    assert tracker.idle(10.0 + times.hold - 0.01) is None
    swing = [tracker.idle(10.0 + times.hold + t) for t in (0.0, times.period / 4, 3 * times.period / 4)]
    yaws = [degrees(angles["HeadYaw"]) for angles in swing if angles]
    middle = degrees(seen_at["HeadYaw"])
    assert yaws == pytest.approx([middle, middle + 30, middle - 30]), "first to the side where the face was"
    assert tracker.idle(10.0 + times.hold + times.search + 0.1) == pytest.approx(
        {"HeadYaw": 0.0, "HeadPitch": radians(-10)}
    )
    tracker.pose(21.0, HERE)
    assert tracker.see({"x": 160, "y": 120}, 21.0) is not None
    assert tracker.idle(22.0) is None, "a new sight ends the search"


def test_a_tracker_that_never_saw_a_face_searches_from_where_it_is(head: Controller) -> None:
    tracker = Tracker(head, HEAD)
    assert tracker.idle(5.0) is None, "no pose yet"
    tracker.pose(5.0, {"HeadYaw": 0.2, "HeadPitch": 0.1})
    assert tracker.idle(5.0) is None
    assert tracker.idle(5.0 + head.tracking.hold) == pytest.approx({"HeadYaw": 0.2, "HeadPitch": 0.1})


def test_the_search_moves_no_faster_than_the_head_is_allowed_to(head: Controller) -> None:
    fastest = radians(30) * 2 * pi / head.tracking.period
    assert fastest <= HEAD.joints["HeadYaw"].speed * head.tracking.speed


def test_the_fixture_sees_the_adult() -> None:
    assert seen(ADULT, TOP, *off_by(ADULT, 15, 8)) is not None
