"""Motions as data: the robot plays the motion that was sent, and nothing else."""

from typing import Any

import pytest

import lumen
from lumen.errors import RobotError
from lumen.language.projects import Project
from lumen.robot.motion_codec import MAX_MOTION_DURATION, decode_motion, encode_motion
from tests import ROOT
from tests.tables import for_each


@pytest.fixture(scope="module")
def project() -> Project:
    return lumen.load(ROOT)


def test_what_arrives_is_the_motion_that_was_sent(project: Project) -> None:
    for motion in project.motions.values():
        found = decode_motion(encode_motion(motion), project.body)
        assert (found.tracks, found.duration, found.start, found.end) == (
            motion.tracks,
            motion.duration,
            motion.start,
            motion.end,
        )
        assert [(c.time, c.kind, c.value) for c in found.cues] == [(c.time, c.kind, c.value) for c in motion.cues]


GOOD: dict[str, Any] = {"name": "nod", "duration": 1.0, "tracks": {"HeadPitch": [[0.5, 0.1], [1.0, 0.0]]}}


def test_a_key_needs_no_more_than_time_and_angle(project: Project) -> None:
    assert [key.time for key in decode_motion(GOOD, project.body).tracks["HeadPitch"]] == [0.5, 1.0]


@for_each(
    ("change", "words"),
    [
        ({"tracks": {"Tail": [[1.0, 0.0]]}}, "no joint `Tail`"),
        ({"tracks": {"HeadPitch": [[1.0, 9.0]]}}, "`HeadPitch` can move from"),
        ({"tracks": {"HeadPitch": [[1.0, "up"]]}}, "must be a number"),
        ({"tracks": {"HeadPitch": [[1.0, float("nan")]]}}, "must be a number"),
        ({"tracks": {"HeadPitch": [[0.0, 0.1]]}}, "must be above 0 and increase"),
        ({"tracks": {"HeadPitch": [[1.0, 0.1], [1.0, 0.2]]}}, "must be above 0 and increase"),
        ({"tracks": {"HeadPitch": []}}, "must be above 0 and increase"),
        ({"tracks": {"HeadPitch": [[1.0, 0.1, "magic"]]}}, "there is no interpolation `magic`"),
        ({"tracks": {"HeadPitch": [[1.0, 0.1, "linear", 1.0]]}}, "a key of `HeadPitch` must be a list"),
        ({"tracks": {"HeadPitch": [[i + 1.0, 0.0] for i in range(20_001)]}}, "more than 20,000"),
        ({"tracks": []}, "needs a `name`"),
        ({"duration": MAX_MOTION_DURATION + 1}, "must take 0 to 600 s"),
        ({"duration": None}, "must be a number"),
        ({"start": "Handstand"}, "no posture `Handstand`"),
        ({"cues": [[1.0, "leds"]]}, "a cue of `nod`"),
        ({"origin": 3}, "the `origin` of `nod`"),
    ],
)
def test_what_is_no_motion_of_this_body_is_refused(project: Project, change: dict[str, Any], words: str) -> None:
    with pytest.raises(RobotError, match=words.replace("(", r"\(")):
        decode_motion({**GOOD, **change}, project.body)


def test_what_is_no_object_is_refused(project: Project) -> None:
    with pytest.raises(RobotError, match="must be an object"):
        decode_motion("dance", project.body)
