"""The same task for Gymnasium, and so for the libraries that learn with it.

env = gymnasium.wrappers.RecordEpisodeStatistics(NaoPushed(seed=0))
"""

from typing import Any

import gymnasium
import numpy as np
from push_task import environment

VIEW = "view"
MOST = 0.6
"""How far an action of 1 moves a joint from where it stands [rad]; the opening of a hand likewise."""


class NaoPushed(gymnasium.Env[np.ndarray, np.ndarray]):
    """Observations are those of the task one after another, in the order of their names; `spans` says which is where.

    An action is a number in [-1, 1] for each motor, 0 where the posture Stand has it. What it is worth is 0..1 a step.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}  # noqa: RUF012  # as Gymnasium has it

    def __init__(self, seed: int | None = None, render_mode: str | None = None, **task: Any) -> None:
        self._task, self._env = task, environment(seed, **task)
        self.render_mode = render_mode
        spec, at = self._env.observation_spec(), 0
        self.spans = dict[str, slice]()
        for name in sorted(spec):
            size = int(np.prod(spec[name].shape))
            self.spans[name.removeprefix("nao/")] = slice(at, at + size)
            at += size
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (at,), np.float64)
        actions = self._env.action_spec()
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, actions.shape, np.float64)
        self._low, self._high = actions.minimum, actions.maximum
        self._stand = self.robot.action_of("Stand")

    @property
    def robot(self) -> Any:
        """The entity in its world."""
        return self._env.task.nao

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None:
            self._env.random_state.seed(seed)
        return self._flat(self._env.reset().observation), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        told = np.clip(self._stand + MOST * np.asarray(action), self._low, self._high)
        now = self._env.step(told)
        fallen = now.last() and now.discount == 0.0
        return self._flat(now.observation), float(now.reward), fallen, now.last() and not fallen, {}

    def action_for(self, angles: np.ndarray) -> np.ndarray:
        """The action that tells the motors these angles, as far as one may."""
        return np.clip((angles - self._stand) / MOST, -1.0, 1.0)

    def render(self) -> np.ndarray | None:
        if self.render_mode != "rgb_array":
            return None
        return np.asarray(self._env.physics.render(480, 640, camera_id=VIEW))

    def close(self) -> None:
        self._env.close()

    def _flat(self, seen: dict[str, np.ndarray]) -> np.ndarray:
        return np.concatenate([np.ravel(seen[name]) for name in sorted(seen)]).astype(np.float64)
