"""The NAO in machine learning: a Walker, a dm_env task, a Gymnasium environment, and the shipped policy."""

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from dm_control import composer
from gymnasium.utils.env_checker import check_env

import lumen
from lumen.features.simulation.entity import Nao
from tests import ROOT
from tests.features.simulation.locomotion import floors, go_to_target

pytestmark = pytest.mark.rest  # expensive


@pytest.fixture(scope="module", autouse=True)
def learning() -> Iterator[None]:
    """Let the programs of the example import each other, as they do if they are run."""
    sys.path.insert(0, str(ROOT / "examples/learning"))
    yield
    sys.path.remove(str(ROOT / "examples/learning"))


@pytest.fixture(scope="module")
def walking() -> composer.Environment:
    """A task of dm_control's own, with our robot as its walker."""
    walker = Nao(lumen.load(ROOT).body, ROOT / "models")
    task = go_to_target.GoToTarget(walker=walker, arena=floors.Floor(), physics_timestep=0.002, control_timestep=0.02)
    return composer.Environment(task, time_limit=1.0, random_state=0, strip_singleton_obs_buffer_dim=True)


def test_it_is_a_walker_of_tasks_that_others_wrote(walking: composer.Environment) -> None:
    now, nao = walking.reset(), walking.task._walker
    assert nao.aliveness(walking.physics) == pytest.approx(0.0, abs=1e-3)
    while not now.last():
        now = walking.step(nao.action_of("Stand"))
    assert nao.aliveness(walking.physics) == pytest.approx(0.0, abs=1e-3)
    assert walking.physics.bind(nao.root_body).xpos[2] == pytest.approx(0.33, abs=0.01)
    assert (nao.prev_action == nao.action_of("Stand")).all()


@pytest.mark.pictures
def test_it_feels_what_the_robot_does_in_the_robots_order(walking: composer.Environment) -> None:
    walking.reset()
    nao, physics = walking.task._walker, walking.physics
    nao.take(physics, "Crouch")
    physics.forward()
    seen = {name.partition("/")[2]: one for name, one in nao.observables.as_dict().items()}

    def value(name: str) -> Any:
        return seen[name].observation_callable(physics, np.random.RandomState(0))()

    assert value("joints_pos") == pytest.approx(list(nao.body.postures["Crouch"].values()))
    assert value("joints_vel").shape == (len(nao.body.joints),)
    assert value("tilt") == pytest.approx([0, 0], abs=1e-6)
    assert {value(f"sensors_{name}").shape for name in ("gyro", "accelerometer")} == {(3,)}
    assert value("end_effectors_pos").shape == (12,)
    for _ in range(500):
        physics.step()
    weight = sum(physics.model.body_mass) * 9.81
    assert value("soles").sum() == pytest.approx(weight, rel=0.1)
    image = value("camera_top")
    assert (image.shape, image.dtype) == ((240, 320, 3), np.uint8)
    assert value("camera_bottom").std() > 0


@pytest.mark.filterwarnings("ignore:.*observation space .* value is")  # angles and forces have no bound that it means
def test_gymnasium_finds_nothing_wrong_with_the_environment() -> None:
    from gym_env import NaoPushed

    env = NaoPushed(seed=0)
    check_env(env, skip_render_check=True)
    first, _ = env.reset(seed=3)
    again, _ = env.reset(seed=3)
    assert (first == again).all()
    assert first[env.spans["tilt"]] == pytest.approx([0, 0], abs=1e-6)
    assert env.action_for(env.robot.action_of("Stand")) == pytest.approx(np.zeros(env.action_space.shape))


def test_who_falls_ends_the_episode_and_who_stands_comes_to_its_end() -> None:
    from gym_env import NaoPushed

    for impulse, falls in ((8.0, True), (0.1, False)):
        env = NaoPushed(seed=0, impulses=(impulse, impulse))
        env.reset()
        fallen = over = False
        earned = 0.0
        while not (fallen or over):
            _, worth, fallen, over, _ = env.step(np.zeros(env.action_space.shape))
            earned += worth
        assert (fallen, over) == (falls, not falls)
        assert falls or earned > 145


def test_the_policy_keeps_robots_on_their_feet_that_fall_without_it() -> None:
    from evaluate import DIRECTIONS, Trials
    from linear_policy import trained

    trials, pushes = Trials(), [(seed, 3.0, direction) for seed, direction in enumerate(DIRECTIONS)]
    with_it, without = (sum(trials.stays(*push, weights) for push in pushes) for weights in (trained(), 0 * trained()))
    assert with_it > without
