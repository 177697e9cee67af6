"""How many of so many pushed robots stay on their feet: with the policy, and with motors that just hold the posture.

python examples/learning/evaluate.py [--robots 20] [--impulses 1 2 3]
"""

import argparse
from math import degrees, pi

import numpy as np
from linear_policy import LinearPolicy, trained
from push_task import environment

DIRECTIONS = tuple(2 * pi * number / 10 for number in range(10))


class Trials:
    """One robot after another, each pushed once."""

    def __init__(self) -> None:
        self._env = environment()
        self._nao = self._env.task.nao

    def stays(self, seed: int, impulse: float, direction: float, weights: np.ndarray) -> bool:
        """Whether a robot that is pushed so is upright when its episode ends; of zeros, the motors hold Stand."""
        self._env.task.impulses, self._env.task.direction = (impulse, impulse), direction
        self._env.random_state.seed(seed)
        now = self._env.reset()
        policy = LinearPolicy(weights, [motor.name for motor in self._nao.actuators], self._nao.action_of("Stand"))
        while not now.last():
            felt = (now.observation[f"nao/{name}"][None] for name in ("tilt", "sensors_gyro", "soles"))
            now = self._env.step(policy(*felt)[0])
        return bool(now.discount)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robots", type=int, default=20, help="for each impulse, pushed from ten directions")
    parser.add_argument("--impulses", type=float, nargs="+", default=[1.0, 2.0, 3.0], help="[N s]")
    asked = parser.parse_args()
    trials, policy = Trials(), trained()
    for impulse in asked.impulses:
        rows = [(seed, impulse, DIRECTIONS[seed % len(DIRECTIONS)]) for seed in range(asked.robots)]
        with_it = [trials.stays(*row, policy) for row in rows]
        without = [trials.stays(*row, 0 * policy) for row in rows]
        fallen = {round(degrees(row[2])) for row, stood in zip(rows, with_it, strict=True) if not stood}
        lost = ", ".join(map(str, sorted(fallen)))
        print(
            f"{impulse:g} N s: {sum(with_it)} of {asked.robots} with the policy, {sum(without)} without"
            + (f"; fallen where pushed towards {lost} deg" if lost else ""),
            flush=True,
        )


if __name__ == "__main__":
    main()
