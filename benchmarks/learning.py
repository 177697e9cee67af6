"""Measure the simulation speed of the NAO for learning: through the environment, bare, and by `mujoco.rollout`.

    python benchmarks/learning.py

A step is 2 ms of physics. Figures are medians of five runs; processor time is independent of other load.
"""

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import mujoco
import numpy as np
from mujoco import rollout

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "examples/learning"))

from push_task import CONTROL_PERIOD, PHYSICS_PERIOD, environment  # noqa: E402

RUNS, CONTROLS, ROBOTS = 5, 50, 32
EACH = round(CONTROL_PERIOD / PHYSICS_PERIOD)


def main() -> None:
    env = environment(seed=0, impulses=(0.1, 0.1))
    env.reset()
    stand, model = env.task.nao.action_of("Stand"), env.physics.model.ptr
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.empty(mujoco.mj_stateSize(model, whole))
    mujoco.mj_getState(model, env.physics.data.ptr, state, whole)
    told, data = env.physics.data.ctrl.copy(), mujoco.MjData(model)

    def through() -> int:
        env.reset()
        for _ in range(CONTROLS):
            env.step(stand)
        return CONTROLS * EACH

    def bare() -> int:
        mujoco.mj_setState(model, data, state, whole)
        data.ctrl[:] = told
        for _ in range(CONTROLS * EACH):
            mujoco.mj_step(model, data)
        return CONTROLS * EACH

    def together(threads: int) -> Callable[[], int]:
        many, all_data = np.tile(told, (ROBOTS, 1, 1)), [mujoco.MjData(model) for _ in range(threads)]

        def run() -> int:
            states = np.tile(state, (ROBOTS, 1))
            for _ in range(CONTROLS // 5):
                after, _ = rollout.rollout(model, all_data, states, many, nstep=EACH, persistent_pool=True)
                states = after[:, -1]
            return ROBOTS * (CONTROLS // 5) * EACH

        return run

    cores = os.cpu_count() or 1
    rows = {"the environment": through, "mj_step": bare, "mujoco.rollout, 1 thread": together(1)}
    if cores > 1:
        rows[f"mujoco.rollout, {cores} threads"] = together(cores)
    for name, run in rows.items():
        run()
        figures = [_timed(run) for _ in range(RUNS)]
        wall, cpu = (median(column) for column in zip(*figures, strict=True))
        print(f"{name:<26} {wall:8,.0f} steps a second, {cpu:8,.0f} a second of CPU", flush=True)


def _timed(run: Callable[[], int]) -> tuple[float, float]:
    """Return the steps per second of wall time and of processor time."""
    began, used = time.perf_counter(), time.process_time()
    steps = run()
    return steps / (time.perf_counter() - began), steps / (time.process_time() - used)


if __name__ == "__main__":
    main()
