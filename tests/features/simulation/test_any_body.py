"""Features that work with any body: examination, films, link poses, eye lights and the camera."""

from pathlib import Path

import numpy as np
import pytest

from lumen.features.simulation.filming.film import Film
from lumen.features.simulation.link_frames import LinkFrames
from lumen.features.simulation.subject import subject
from lumen.language.commands import Leds, Posture
from lumen.language.robots import Body
from lumen.ports import Image, Joints, Sense
from tests.features.simulation.bodies import shipped, standing
from tests.features.simulation.conftest import MODELS, answer, until_answered
from tests.features.simulation.walks import floor

BODIES = ("greeter", "lantern", "sprout")


@pytest.fixture(params=BODIES)
def body(request: pytest.FixtureRequest) -> Body:
    return shipped(request.param)


@pytest.mark.slow
def test_it_is_examined_with_other_masses(body: Body) -> None:
    robot = subject(body, MODELS, floor(), 2)
    robot.start("x", Posture("Stand", 1.0))
    robot.advance(1.0)
    strain = robot.strain()
    assert not strain.touching
    assert not strain.exhausted
    assert set(strain.soles) == ({"L", "R"} if body.roles.soles else set())
    weight = 9.81 * robot.world.model.body_subtreemass[robot.world.torso]
    if body.roles.soles:
        assert sum(sole.load for sole in strain.soles.values()) == pytest.approx(weight, rel=0.1)


def test_two_links_of_it_that_press_on_each_other_are_named() -> None:
    robot = subject(shipped("greeter"), MODELS, floor(), 0)
    robot.motors.aim({"left_arm_lift": -0.25, "left_arm_swing": 1.5, "left_elbow": -1.7, "left_arm_turn": 0.0})
    robot.advance(2.0)
    assert any("left" in " ".join(pair) for pair in robot.strain().touching)


@pytest.mark.pictures
@pytest.mark.slow
def test_it_is_filmed(body: Body, tmp_path: Path) -> None:
    robot = standing(body.mjcf.removesuffix(".xml"))
    film = Film(tmp_path / "film.mp4", robot, size=(320, 180))
    robot.advance(0.1)
    film.tick(robot.time)
    film.close()
    assert (tmp_path / "film.mp4").stat().st_size > 1000


def test_its_links_are_where_its_joints_say(body: Body) -> None:
    robot = standing(body.mjcf.removesuffix(".xml"))
    robot.advance(0.1)
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    frames = {frame.name: frame for frame in LinkFrames(body, MODELS).frames(joints)}
    assert body.roles.torso in frames
    height = robot.world.data.body(robot.world.torso).xpos[2]
    assert frames[body.roles.torso].position[2] == pytest.approx(height, abs=0.01)


@pytest.mark.pictures
@pytest.mark.slow
def test_it_sees(body: Body) -> None:
    image = standing(body.mjcf.removesuffix(".xml")).read(Sense.IMAGE)
    assert isinstance(image, Image)
    assert np.ptp(image.pixels()) > 20


def test_its_eyes_are_lit(body: Body) -> None:
    robot = standing(body.mjcf.removesuffix(".xml"))
    robot.start("x", Leds({"eyes": "red"}, 0.1))
    assert answer(until_answered(robot, "x"), "x") == "done"
    assert all(
        robot.lights.shown(light)[0] > 0.8 > 0.5 > robot.lights.shown(light)[2] for light in body.roles.lights["eyes"]
    )
