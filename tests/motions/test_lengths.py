"""Joints that slide: lengths in the files of bodies, motions, life and gestures, and the findings about them."""

from math import radians
from pathlib import Path

import pytest

import lumen
from lumen.language.commands import Posture, Rest
from lumen.language.mirrors import mirror_of
from lumen.motion.projection import seen
from lumen.robot.command_table import parts_of
from tests.tables import for_each

BODY = """\
name: Mast
mjcf: none
units: {angle: deg, length: mm}
joints:
  trunk: {range: [-90, 90], speed: 100}
  side: {range: [-20, 20], speed: 100, sliding: true}
  height: {range: [-30, 20], speed: 100, sliding: true}
  tilt: {range: [-30, 30], speed: 100}
parts: {head: [side, height, tilt], body: [trunk]}
roles:
  head: {roll: tilt, y: side, z: height}
  body: {yaw: trunk}
camera: {width: 320, height: 240, horizontal_fov: 60, vertical_fov: 45, position: [0, 0, 0], neck: [0, 0, 500]}
postures: {Stand: {trunk: 0, side: 0, height: 5, tilt: 0}}
"""
MOTION = """\
units: {angle: deg, length: mm}
poses:
  left: {roles: {head.y: 10, head.z: 12, head.roll: -20, body.yaw: 30}}
  right: {pose: left, mirror: true}
keyframes:
  - {at: 1s, pose: left}
  - {at: 3s, pose: right}
"""
LIFE = """\
units: {length: cm}
sways: {breathing: {period: 4s, roles: {head.z: 0.5}}}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    files = {
        "lumen.yaml": "name: Mast\nbehavior: b\nlanguages: [en]\nrobot: {name: Mast, model: mast}\n",
        "behaviors/b.yaml": "initial: a\nstates: {a: {life: calm, do: {play: lean}}}\n",
        "models/mast.yaml": BODY,
        "motions/lean.yaml": MOTION,
        "motions/life/calm.yaml": LIFE,
    }
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    return tmp_path


def test_lengths_are_metres_inside(project: Path) -> None:
    found = lumen.load(project)
    height = found.body.joints["height"]
    assert (height.minimum, height.maximum, height.speed) == pytest.approx((-0.03, 0.02, 0.1))
    assert found.body.slides == ("side", "height")
    assert found.body.postures["Stand"]["height"] == pytest.approx(0.005)
    assert found.motions["lean"].tracks["height"][0].angle == pytest.approx(0.012)
    assert found.life["calm"].amplitudes == pytest.approx({"height": 0.005})


def test_a_mirror_reverses_what_goes_to_a_side_and_keeps_what_goes_up(project: Path) -> None:
    found = lumen.load(project)
    assert mirror_of(found.body) == {
        "tilt": ("tilt", -1.0),
        "side": ("side", -1.0),
        "height": ("height", 1.0),
        "trunk": ("trunk", -1.0),
    }
    right = {joint: keys[1].angle for joint, keys in found.motions["lean"].tracks.items()}
    assert right == pytest.approx({"side": -0.01, "height": 0.012, "tilt": radians(20), "trunk": radians(-30)})


def test_a_trunk_that_turns_has_one_owner(project: Path) -> None:
    found = lumen.load(project)
    for command in (Posture("Stand"), Rest()):
        assert "body" in parts_of(command, found.body)


def test_the_camera_has_the_neck_of_its_own_body(project: Path) -> None:
    camera = lumen.load(project).body.camera
    assert camera
    assert camera.neck == (0.0, 0.0, 0.5)
    assert seen((2.0, 0.0, 0.5), camera, 0.0, 0.0) == pytest.approx((160, 120))


@for_each(
    ("file", "old", "new", "words"),
    [
        ("motions/lean.yaml", "head.z: 12", "head.z: 25", "Mast can't bring `head.z` to 25 mm: it stops at its limit"),
        ("motions/lean.yaml", "roles: {head.y: 10, ", "joints: {side: 30}, roles: {", "`side` can't go to 30 mm"),
        ("motions/lean.yaml", "at: 3s", "at: 1.1s", "`trunk` would have to move at"),
        (
            "motions/life/calm.yaml",
            "0.5}}}",
            "0.5}}}\nsettles: {takes: 9s, roles: {head.z: 2}}",
            "`height` would go 2.5 cm to either side",
        ),
        ("motions/life/calm.yaml", "head.z:", "head.up:", "there is no role `head.up`"),
        ("models/mast.yaml", "height: 5,", "height: 50,", "`height` can't reach 50"),
    ],
)
def test_messages_have_the_unit_of_the_file(project: Path, file: str, old: str, new: str, words: str) -> None:
    text = (project / file).read_text()
    assert old in text
    (project / file).write_text(text.replace(old, new))
    messages = [finding.message for finding in lumen.check(project)]
    (project / file).write_text(text)  # the next row begins with the same files
    assert any(message.startswith(words) for message in messages), messages
