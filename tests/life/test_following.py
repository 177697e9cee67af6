"""A head that follows a face lives about the face: it neither runs away, nor does the follower answer its life."""

from math import degrees

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import lumen
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.body_parts import HEAD, WHOLE_BODY
from lumen.language.life import LifeStyle
from lumen.language.stories import Visitor
from lumen.motion.projection import Vector3, centring, seen
from lumen.motion.tracking import Tracker
from lumen.ports import Live
from lumen.robot.life_layer import LifeLayer
from tests import ROOT
from tests.fuzzy import physical_loop

PROJECT = lumen.load(ROOT)
BODY, CONTROLLER = PROJECT.body, PROJECT.controllers["head"]
JOINTS = BODY.parts[HEAD]
STYLES = sorted(PROJECT.life)
STEP, LATENCY = 0.02, 0.1
WITHIN = np.radians(1.0)
"""The greatest error of the follower itself [rad]: a pixel is 0.2 degrees."""


def reach(style: LifeStyle) -> np.ndarray:
    """Return the greatest movement of yaw and pitch in this style of life [rad]."""
    turns, nods = [each for each in (style.glances, style.asides) if each], style.nods
    turned = np.max([[0.0, 0.0], *([each.yaw, each.pitch] for each in turns)], axis=0)
    swayed = np.array([style.amplitudes.get(joint, 0.0) for joint in JOINTS])
    return turned + swayed + np.array([0.0, nods.pitch if nods else 0.0])


def followed(face: Vector3, style: str, seed: int, *, told: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the pose of a weightless living head under the follower, and its gaze [rad]: a row each 20 ms of 20 s.

    If `told`, the poses include their part of life.
    """
    layer, tracker = LifeLayer(BODY, seed), Tracker(CONTROLLER, BODY)
    layer.style = PROJECT.life[style]
    goal, aims, poses, images = np.zeros(2), [], [], []
    for tick in range(1000):
        now = tick * STEP
        lived = layer.advance(now, STEP, WHOLE_BODY, lambda _part: 1.0)
        pose = goal + [lived.get(joint, 0.0) for joint in JOINTS]
        tracker.pose(now, dict(zip(JOINTS, pose, strict=True)), life=lived if told else None)
        if tick % 5 == 0 and (pixel := seen(face, BODY.camera, *pose)):
            images.append((now, pixel))
        if images and now >= images[0][0] + LATENCY:
            captured, (x, y) = images.pop(0)
            if aim := tracker.see({"x": round(x), "y": round(y)}, captured, now=now):
                goal = np.array([aim[joint] for joint in JOINTS])
        aims.append(goal)
        poses.append(pose)
    return np.array(aims), np.array(poses)


@settings(max_examples=12, deadline=None)
@given(st.floats(1.0, 2.5), st.floats(-0.6, 0.6), st.floats(0.1, 0.5), st.sampled_from(STYLES), st.integers(0, 99))
def test_whoever_stands_there_is_looked_at(x: float, y: float, z: float, style: str, seed: int) -> None:
    face, far = (x, y, z), reach(PROJECT.life[style])
    aims, poses = followed(face, style, seed, told=True)
    late = slice(200, None)
    assert (np.abs(aims[late] - centring(face, BODY.camera)) < WITHIN).all()
    assert (np.abs(poses[late] - centring(face, BODY.camera)) < far + WITHIN).all()
    assert (np.abs(poses[late] - aims[late]).max(axis=0) > 0.2 * far).all()


def test_a_follower_that_is_not_told_answers_its_own_glances() -> None:
    face = (1.5, 0.2, 0.3)
    aims, _ = followed(face, "calm", 0, told=False)
    assert np.abs(aims[200:] - centring(face, BODY.camera)).max() > 3 * WITHIN


@pytest.mark.parametrize(
    "style", [pytest.param(name, marks=pytest.mark.soak) for name in STYLES if name != "lively"] + ["lively"]
)
@pytest.mark.parametrize("visitor", [Visitor(1.4, 0.3, 1.6)])
def test_with_weight_too(monkeypatch: pytest.MonkeyPatch, style: str, visitor: Visitor) -> None:
    def alive(*given: object, **named: object) -> SimulatedRobot:
        robot = SimulatedRobot(*given, **named)  # type: ignore[arg-type]
        robot.start("", Live(PROJECT.life[style]))
        return robot

    monkeypatch.setattr(physical_loop, "SimulatedRobot", alive)
    outcome = physical_loop.run(
        PROJECT, lambda now: visitor, (12.0, -6.0), duration=10.0 if style == "lively" else 40.0
    )
    late = np.array([pose[1:] for pose in outcome.poses if pose[0] > 3.0])
    assert (np.degrees(np.abs(late).max(axis=0)) < np.degrees(reach(PROJECT.life[style])) + 1.5).all()
    assert degrees(np.ptp(late[:, 0])) > 1.0
