"""Finds the weights of the linear policy by CMA-ES (Hansen 2016), and keeps them in policy.json.

    python examples/learning/train.py [--generations 60] [--pushes 8] [--seed 0]

Needs `pip install 'lumen-robot[search]'`. All robots of a generation live at once, by `mujoco.rollout` on all cores:
from each control step to the next in C, without Python between. A robot of this training feels no noise.
"""

import argparse
import os

import cma
import mujoco
import numpy as np
from linear_policy import SIZE, LinearPolicy, save
from mujoco import rollout
from push_task import CONTROL_PERIOD, EPISODE, FALLEN, PHYSICS_PERIOD, PUSH_TIME, environment

from lumen.features.simulation.entity import sole_sensors

BEGIN = 0.3
STEPS, EACH = round(EPISODE / CONTROL_PERIOD), round(CONTROL_PERIOD / PHYSICS_PERIOD)
FEELS = mujoco.mjtState.mjSTATE_CTRL | mujoco.mjtState.mjSTATE_XFRC_APPLIED
WHOLE = mujoco.mjtState.mjSTATE_FULLPHYSICS
SCALE = np.array([0.5, 0.1, 0.2] * 6 + [0.05] * 2)
"""How large a change of each weight is at first: for an angle, a speed and a pressure; and of the leans."""


class Crowd:
    """As many robots as one likes, each pushed once."""

    def __init__(self) -> None:
        env = environment(seed=0)
        env.reset()
        nao, physics = env.task.nao, env.physics
        self._model = physics.model.ptr
        self._stand, self._motors = nao.action_of("Stand"), [motor.name for motor in nao.actuators]
        self._order = physics.bind(nao.actuators).element_id
        self._torso = physics.bind(nao.root_body).element_id
        self._gyro = _addresses(self._model, ["nao/gyro"])
        self._soles = _addresses(self._model, [f"nao/{name}" for name in sole_sensors(nao.body)])
        self._state = np.empty(mujoco.mj_stateSize(self._model, WHOLE))
        mujoco.mj_getState(self._model, physics.data.ptr, self._state, WHOLE)
        self._data = [mujoco.MjData(self._model) for _ in range(os.cpu_count() or 1)]

    def live(self, weights: np.ndarray, pushes: np.ndarray) -> np.ndarray:
        """How upright each was in the mean, 0..1; `weights` (robots, SIZE), `pushes` (robots, 2) ahead, left [N s]."""
        model, count = self._model, len(weights)
        states = np.tile(self._state, (count, 1))
        sensed = np.zeros((count, model.nsensordata))
        told = np.zeros((count, 1, model.nu + 6 * model.nbody))
        push = told[:, 0, model.nu + 6 * self._torso :][:, :2]
        alive, score = np.ones(count, bool), np.zeros(count)
        for step in range(STEPS):
            up = _up(states[:, 4:8])
            tilt = np.stack([np.arctan2(up[:, 1], up[:, 2]), np.arctan2(-up[:, 0], np.hypot(up[:, 1], up[:, 2]))], 1)
            alive &= up[:, 2] > FALLEN
            score += np.where(alive, (up[:, 2] - FALLEN) / (1 - FALLEN), 0.0)
            if not alive.any():
                break
            here = np.flatnonzero(alive)
            actions = LinearPolicy(weights[here], self._motors, self._stand)(
                tilt[here], sensed[here][:, self._gyro], sensed[here][:, self._soles]
            )
            told[here[:, None], 0, self._order] = actions
            push[:] = pushes / PUSH_TIME if BEGIN <= step * CONTROL_PERIOD < BEGIN + PUSH_TIME else 0.0
            after, felt = rollout.rollout(
                model, self._data, states[here], told[here], control_spec=int(FEELS), nstep=EACH, persistent_pool=True
            )
            states[here], sensed[here] = after[:, -1], felt[:, -1]
        return score / STEPS


def _up(quaternion: np.ndarray) -> np.ndarray:
    """The world's z axis in the frames of these quaternions."""
    w, x, y, z = quaternion.T
    return np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1)


def _addresses(model: mujoco.MjModel, names: list[str]) -> list[int]:
    return [
        at
        for name in names
        for at in range(model.sensor(name).adr[0], model.sensor(name).adr[0] + model.sensor(name).dim[0])
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--generations", type=int, default=60)
    parser.add_argument("--pushes", type=int, default=8, help="for each candidate")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    crowd, random = Crowd(), np.random.default_rng(asked.seed)
    search = cma.CMAEvolutionStrategy(
        np.zeros(SIZE), 0.5, {"CMA_stds": SCALE, "seed": asked.seed + 1, "popsize": 12, "verbose": -9}
    )
    for generation in range(asked.generations):
        candidates = np.array(search.ask())
        angles = random.uniform(0, 2 * np.pi) + np.linspace(0, 2 * np.pi, asked.pushes, endpoint=False)
        sizes = random.permutation(np.linspace(1.5, 3.5, asked.pushes))
        pushes = sizes[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
        each = crowd.live(np.repeat(candidates, asked.pushes, 0), np.tile(pushes, (len(candidates), 1)))
        scores = each.reshape(len(candidates), -1).mean(1)
        search.tell(list(candidates), list(-scores))
        print(f"{generation + 1:3d}: upright {scores.mean():.3f} in the mean, {scores.max():.3f} the best", flush=True)
    save(search.mean, by="train.py", generations=asked.generations, pushes=asked.pushes, seed=asked.seed)


if __name__ == "__main__":
    main()
