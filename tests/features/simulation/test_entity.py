"""The robot in a dm_control world of another project."""

import runpy
from pathlib import Path

import pytest
from dm_control import mjcf

from lumen.errors import RobotError
from lumen.features.simulation.entity import Nao
from lumen.language.robots import Body
from tests.features.simulation.bodies import shipped
from tests.features.simulation.conftest import MODELS
from tests.features.simulation.locomotion import floors

EXAMPLE = MODELS.parent / "examples" / "dm_control" / "nao_in_your_world.py"


@pytest.mark.slow
def test_the_example_crouches(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLE))
    assert capsys.readouterr().out == "its torso is 0.23 m above the ground\n"


@pytest.mark.parametrize("posture", ["Stand", "StandInit", "Crouch"])
def test_two_of_them_stand_in_one_world(body: Body, posture: str) -> None:
    arena = floors.Floor()
    robots = [Nao(body, MODELS, name=name) for name in ("ada", "bob")]
    for robot in robots:
        arena.add_free_entity(robot)
    physics = mjcf.Physics.from_mjcf_model(arena.mjcf_model)
    for robot, x in zip(robots, (0.0, 1.0), strict=True):
        robot.take(physics, posture)
        robot.shift_pose(physics, position=(x, 0.0, 0.0))
    torsos = [robot.mjcf_model.find("body", "Torso") for robot in robots]
    before = physics.bind(torsos).xpos.copy()
    while physics.time() < 1.5:
        physics.step()
    assert abs(physics.bind(torsos).xpos - before).max() < 0.05
    assert physics.bind(robots[0].actuators).ctrl.shape == (len(body.joints) - len(body.shared),)


def test_a_world_of_plain_mjcf_holds_it_too(body: Body) -> None:
    world = mjcf.RootElement()
    world.attach(Nao(body, MODELS).mjcf_model).add("freejoint")
    assert mjcf.Physics.from_mjcf_model(world).model.body("nao/Torso").mass > 1


def test_a_model_that_is_not_there_is_one_clear_error(body: Body, tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"there is no model nao\.xml"):
        Nao(body, tmp_path)


def test_another_biped_feels_and_sees_what_it_has_sensors_for() -> None:
    sprout = Nao(shipped("sprout"), MODELS, name="sprout")
    assert [body.name for body in sprout.end_effectors] == ["left_forearm", "right_forearm", "left_foot", "right_foot"]
    assert [geom.name for geom in sprout.ground_contact_geoms] == ["left_sole", "right_sole"]
    seen = sprout.observables.as_dict(fully_qualified=False)
    assert "camera_top" in seen
    assert "camera_bottom" not in seen
    physics = mjcf.Physics.from_mjcf_model(sprout.mjcf_model)
    assert sprout.observables.soles(physics).shape == (8,)
    assert len(sprout.actuators) == 20
    assert sprout.pose("Stand").xpos[2] == pytest.approx(0.21, abs=0.02)
