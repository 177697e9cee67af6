"""A NAO that is pushed and should stay on its feet: a task of dm_control's composer.

An episode takes three seconds. In its first second the robot's torso is pushed for a tenth of a second from any side;
the task ends when it has fallen. An action is an angle for each motor [rad], an opening for hands, 50 times a second.
"""

from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from dm_control import composer, mjcf
from dm_control.composer.variation import noises
from dm_control.locomotion.arenas import floors

import lumen
from lumen.features.simulation.entity import Nao
from lumen.features.simulation.imperfections import ENCODER_NOISE, GYRO_NOISE

PROJECT = Path(__file__).parents[2]
CONTROL_PERIOD, PHYSICS_PERIOD = 0.02, 0.002
EPISODE, PUSHED_BY, PUSH_TIME = 3.0, 1.0, 0.1
"""How long it is, by when the push has begun, and how long that takes [s]."""
FALLEN = cos(pi / 3)
"""A torso that leans further than 60 degrees: the cosine of that."""


class KeepStanding(composer.Task):
    """Rewards each step with up to 1: upright 1, 0 for one that leans by 60 degrees.

    `impulses` are the least and the most that a push has [N s]; a task of its own for each `impulses` and `direction`
    [rad, 0 is forwards] is what an evaluation asks for.
    """

    def __init__(self, impulses: tuple[float, float] = (1.0, 3.0), direction: float | None = None) -> None:
        self._arena, self.impulses, self.direction = floors.Floor(size=(3.0, 3.0)), impulses, direction
        self.nao = Nao(lumen.load(PROJECT).body, PROJECT / "models")
        self._arena.add_free_entity(self.nao)
        self._arena.mjcf_model.worldbody.add(
            "camera", name="view", pos=(1.2, -0.8, 0.6), xyaxes=(0.55, 0.83, 0, -0.2, 0.13, 0.97)
        )
        seen = self.nao.observables
        for one in (seen.joints_pos, seen.joints_vel, seen.tilt, seen.sensors_gyro, seen.soles):
            one.enabled = True
        seen.joints_pos.corruptor = noises.Additive(_Normal(ENCODER_NOISE))
        seen.sensors_gyro.corruptor = noises.Additive(_Normal(GYRO_NOISE))
        self.set_timesteps(CONTROL_PERIOD, PHYSICS_PERIOD)
        self._begin, self._force = 0.0, (0.0, 0.0)

    @property
    def root_entity(self) -> composer.Entity:
        return self._arena

    def initialize_episode(self, physics: mjcf.Physics, random_state: np.random.RandomState) -> None:
        self.nao.take(physics, "Stand")
        towards = random_state.uniform(0, 2 * pi) if self.direction is None else self.direction
        force = random_state.uniform(*self.impulses) / PUSH_TIME
        self._begin = random_state.uniform(0.5, PUSHED_BY)
        self._force = (force * cos(towards), force * sin(towards))

    def before_step(self, physics: mjcf.Physics, action: np.ndarray, random_state: np.random.RandomState) -> None:
        self.nao.apply_action(physics, action, random_state)
        pushed = self._begin <= physics.time() < self._begin + PUSH_TIME
        physics.bind(self.nao.root_body).xfrc_applied[:2] = self._force if pushed else (0.0, 0.0)

    def get_reward(self, physics: mjcf.Physics) -> float:
        return max(0.0, (self._upright(physics) - FALLEN) / (1.0 - FALLEN))

    def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
        return self._upright(physics) < FALLEN

    def get_discount(self, physics: mjcf.Physics) -> float:
        return 0.0 if self.should_terminate_episode(physics) else 1.0

    def _upright(self, physics: mjcf.Physics) -> float:
        """The cosine of how far the torso leans."""
        return float(physics.bind(self.nao.root_body).xmat[-1])


class _Normal:
    """Draws what a sensor adds."""

    def __init__(self, deviation: float) -> None:
        self._deviation = deviation

    def __call__(
        self, initial_value: Any = None, current_value: Any = None, random_state: np.random.RandomState | None = None
    ) -> np.ndarray:
        return (random_state or np.random).normal(0.0, self._deviation, np.shape(current_value))


def environment(seed: int | None = None, **task: Any) -> composer.Environment:
    """The task as a dm_env.Environment, the same for the same seed."""
    return composer.Environment(
        KeepStanding(**task), time_limit=EPISODE, random_state=seed, strip_singleton_obs_buffer_dim=True
    )
