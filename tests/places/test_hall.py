"""Lint's plan of a hall agrees with MuJoCo's, seen from above; and the ways through it."""

from math import cos, pi, sin
from pathlib import Path

import mujoco
import pytest

from lumen.lint.hall_obstacles import GroundPoint, Obstacle, nearest, obstacles
from lumen.lint.ways import _followers
from lumen.statechart import Machine
from tests import ROOT
from tests.tables import for_each

HALL = (Path(ROOT) / "models" / "hall.xml").read_bytes()


def on_the_floor(content: bytes) -> bytes:
    """Return the hall with the robot on the floor next to the podium."""
    return content.replace(b'name="stage" pos="0 0 0.5"', b'name="stage" pos="0.9 0.4 0"')


def test_on_the_podium_nothing_is_near_and_beside_it_the_podium_is() -> None:
    assert nearest(obstacles(HALL), GroundPoint(0, 0), GroundPoint(0.4, 0.4)) > 0.8
    assert nearest(obstacles(on_the_floor(HALL)), GroundPoint(0, 0), GroundPoint(-0.8, 0)) == 0.0
    assert nearest(obstacles(on_the_floor(HALL)), GroundPoint(0, 0), GroundPoint(0, 0)) == pytest.approx(0.35)


@pytest.mark.physics
def test_every_solid_box_of_the_shipped_hall_is_where_mujoco_has_it() -> None:
    model = mujoco.MjModel.from_xml_path(str(Path(ROOT) / "models" / "hall.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    boxes = set()
    for i in range(model.ngeom):
        half, (x, y, z), axes = model.geom_size[i], data.geom_xpos[i], data.geom_xmat[i]
        touched = model.geom_contype[i] or model.geom_conaffinity[i]
        if touched and model.geom_type[i] == mujoco.mjtGeom.mjGEOM_BOX and z - half[2] < 1.1 and z + half[2] > 0.52:
            reached = x + axes[0] * half[0] + axes[1] * half[1], y + axes[3] * half[0] + axes[4] * half[1]
            boxes.add(tuple(round(float(n), 6) for n in reached))
    assert boxes == {corner(shape) for shape in obstacles(HALL)}
    assert len(boxes) >= 6


def corner(box: Obstacle) -> tuple[float, float]:
    c, s = cos(box.yaw), sin(box.yaw)
    return (
        round(box.x + box.length * c - box.width * s, 6),
        round(box.y + box.length * s + box.width * c, 6),
    )


def hall(geom: str, more: str = "") -> bytes:
    return f'<mujoco>{more}<worldbody><site name="stage"/>{geom}</worldbody></mujoco>'.encode()


@for_each(
    ("geom", "distance"),
    [
        ('<geom type="box" size=".5 .1 .5" pos="2 0 0"/>', 1.5),
        ('<body pos="2 0 0" euler="0 0 90"><geom type="box" size=".5 .1 .5"/></body>', 1.9),
        ('<body pos="1 0 0"><body pos="1 0 0"><geom type="cylinder" size=".3 .5"/></body></body>', 1.7),
        ('<geom type="capsule" size=".1 .2" pos="2 0 0" euler="0 90 0"/>', 2.0 - (0.1**2 + 0.2**2) ** 0.5),
        ('<geom type="capsule" size=".1" fromto="1.8 0 .3 2.2 0 .3"/>', 1.7),
        ('<geom size=".25" pos="0 2 .2"/>', 1.75),
        ('<geom type="box" size=".5 .1 .1" pos="2 0 2"/>', None),
        ('<geom type="box" size=".5 .1 .005" pos="2 0 0"/>', None),
        ('<geom type="plane" size="5 5 .1"/>', None),
        ('<geom type="box" size=".5 .1 .5" pos="2 0 0" contype="0" conaffinity="0"/>', None),
        ('<geom type="box" size=".5 .1" pos="2 0 0"/>', None),
        ('<geom type="box" size=".5 nan .1" pos="2 0 0"/>', None),
    ],
)
def test_what_is_solid_and_how_far(geom: str, distance: float | None) -> None:
    here = GroundPoint(0.0, 0.0)
    assert nearest(obstacles(hall(geom)), here, here) == (pytest.approx(distance) if distance else float("inf"))


def test_classes_say_what_is_solid() -> None:
    classes = (
        '<default><geom contype="0" conaffinity="0"/><default class="solid"><geom contype="2"/></default></default>'
    )
    box = '<geom {} type="box" size=".5 .1 .5" pos="2 0 0"/>'
    assert obstacles(hall(box.format(""), classes)) == ()
    assert len(obstacles(hall(box.format('class="solid"'), classes))) == 1
    assert len(obstacles(hall(f'<body childclass="solid">{box.format("")}</body>', classes))) == 1


def test_a_file_that_is_no_hall_has_nothing() -> None:
    assert obstacles(b"<mujoco") == ()
    assert obstacles(b"<mujoco><worldbody><geom size='1'/></worldbody></mujoco>") == ()


def test_a_way_that_is_turned_is_near_what_it_passes() -> None:
    box = Obstacle(0.0, 1.0, pi / 4, 0.2, 0.2, 0.0)
    assert nearest((box,), GroundPoint(-1.0, 0.0), GroundPoint(1.0, 0.0)) == pytest.approx(1 - 0.2 * 2**0.5, abs=0.001)


def test_walks_that_may_follow_one_another_are_found_across_states() -> None:
    def walk(to: str) -> dict[str, object]:
        return {"walk": {"to": to}}

    states = {
        "a": {"do": [walk("organ"), {"say": "Here"}], "onDone": "talk"},
        "talk": {"on": {"heard": "b", "touched": "c"}},
        "b": {"do": [walk("clock"), walk("globe")], "onDone": "a"},
        "c": {
            "initial": "d",
            "states": {"d": {"do": walk("{{ context.next }}"), "onDone": "e"}, "e": {}},
            "on": {"x": "b"},
        },
    }
    machine = Machine.from_dict({"id": "m", "context": {"next": ""}, "initial": "a", "states": states}, "m")
    assert {(before, walk.to) for before, walk in _followers(machine)} == {
        ("", "organ"), ("organ", "clock"), ("organ", "{{ context.next }}"), ("clock", "globe"), ("globe", "organ"),
        ("{{ context.next }}", "clock"),
    }  # fmt: skip
