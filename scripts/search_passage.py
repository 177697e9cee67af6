"""Searches a better passage from the one in a file, with CMA-ES in simulation (`pip install 'lumen-robot[search]'`):

    python scripts/search_passage.py models/passages/straddle-crouch.yaml --evaluations 500 --robots 4 -o found.yaml

What may change are the numbers of the file: the angles of its poses, in whole degrees, and the times between its
keyframes. What is written is the same file with other numbers; the posture that it ends in stays as it is.
"""

import argparse
import re
from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import ceil, floor, radians
from pathlib import Path

import mujoco
import numpy as np
import yaml

import lumen
from lumen.interpreters.limits import beyond_limits, overspeed
from lumen.interpreters.trajectory import Trajectory
from lumen.language.commands import Posture
from lumen.language.robots import Body
from lumen.motion import Motion
from lumen.robots.simulation import SimulatedRobot
from lumen.robots.simulation.model_terms import Variation
from lumen.robots.simulation.world import CONTROL_PERIOD

MISS, EFFORT, BUMP, TIME, BEYOND, WORST = 2.0, 0.4, 1.0, 0.01, 1.0, 0.3
"""The price of how far the torso's up ends from where it should, of the mean of the motors' load cubed, of what the
torso sinks faster than `GENTLE` [m/s], of each second, and of each radian (per second) beyond the body's limits. The
robots' mean counts, and `WORST` times the worst of them."""

GENTLE, SETTLING = 0.3, 1.0

ANGLE, TIMES = 8.0, 0.15
"""How far around the search looks at first: [degrees], [s]."""

_ANGLE, _TIME = re.compile(r"\b([LRH]\w+): (-?\d+)(?=[,}])"), re.compile(r"(?<=at: )[\d.]+(?=s)")


class Text:
    """The text of a passage as `numbers`: so many `angles` of its poses [degrees], then times between keyframes [s].

    `reach` is how far around each of them a search looks at first.
    """

    def __init__(self, text: str, body: Body) -> None:
        self._text = text
        self._joints = [body.joints[name] for name, _ in _ANGLE.findall(text)]
        self.angles = len(self._joints)
        times = [0.0, *map(float, _TIME.findall(text))]
        self.numbers = [float(angle) for _, angle in _ANGLE.findall(text)] + [b - a for a, b in pairwise(times)]
        self.reach = [ANGLE] * self.angles + [TIMES] * (len(times) - 1)

    def written(self, numbers: Sequence[float]) -> str:
        """The passage with these numbers, inside the joints' limits; no two keyframes come closer than 0.05 s."""
        angles = iter(
            min(max(round(number), ceil(joint.minimum / radians(1))), floor(joint.maximum / radians(1)))
            for joint, number in zip(self._joints, numbers[: self.angles], strict=True)
        )
        times = iter(np.cumsum(np.maximum(numbers[self.angles :], 0.05)).tolist())
        text = _ANGLE.sub(lambda match: f"{match[1]}: {next(angles)}", self._text)
        return _TIME.sub(lambda _: f"{next(times):.2f}", text)


class Trial:
    """One robot, of its own weight and on its own floor, that has come to the posture where a passage begins."""

    def __init__(self, body: Body, models: Path, motion: Motion, seed: int) -> None:
        draw = np.random.default_rng(seed)
        variation = Variation(draw.uniform(0.9, 1.1), draw.uniform(0.5, 1.0) / 0.8)
        self._robot = SimulatedRobot(body, models, variation=variation)
        self._come_to(motion.start)
        model, data = self._robot.world.model, self._robot.world.data
        self._all = mujoco.mjtState.mjSTATE_INTEGRATION
        self._begin = np.zeros(mujoco.mj_stateSize(model, self._all))
        mujoco.mj_getState(model, data, self._begin, self._all)
        self._stance = self._robot.motors.goal.copy(), self._robot.motors.command.copy()
        self._come_to(motion.end)
        self._sought = np.array(self._robot.world.up)

    def cost(self, motion: Motion) -> float:
        """What this passage costs here."""
        world, motors = self._robot.world, self._robot.motors
        mujoco.mj_setState(world.model, world.data, self._begin, self._all)
        mujoco.mj_forward(world.model, world.data)
        motors.goal, motors.command = (angles.copy() for angles in self._stance)
        course, loads, sinking = Trajectory(motion, motors.wanted(motion.tracks)), [], 0.0
        still = np.zeros(len(motors.names))
        for tick in range(round((motion.duration + SETTLING) / CONTROL_PERIOD)):
            motors.aim(course.sample(tick * CONTROL_PERIOD))
            motors.drive(still, CONTROL_PERIOD)
            before = world.data.xpos[world.torso][2]
            world.step()
            sinking = max(sinking, float(before - world.data.xpos[world.torso][2]) / CONTROL_PERIOD)
            loads.append(np.mean(np.abs(world.torques[world.driven] / motors.effort[world.driven]) ** 3))
        miss = float(np.linalg.norm(np.array(world.up) - self._sought))
        return MISS * miss + EFFORT * float(np.mean(loads)) + BUMP * max(0.0, sinking - GENTLE) + TIME * motion.duration

    def _come_to(self, posture: str) -> None:
        self._robot.start("p", Posture(posture))
        while not any(event.name.endswith(".command.p") for event in self._robot.poll()):
            self._robot.advance(0.1)
        self._robot.advance(SETTLING)


def cost(text: str, trials: Iterable[Trial], body: Body) -> float:
    """What a passage costs: the robots' mean, the worst of them, and what is beyond the body's limits."""
    motion = Motion.from_dict(yaml.safe_load(text), "passage")
    beyond = sum(abs(e.value - e.limit) for e in (*beyond_limits(motion, body), *overspeed(motion, body)))
    costs = [trial.cost(motion) for trial in trials]
    return float(np.mean(costs)) + WORST * max(costs) + BEYOND * beyond


def main() -> None:
    import cma  # only the search needs it

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("passage", type=Path)
    parser.add_argument("--evaluations", type=int, default=500)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sigma", type=float, default=0.5, help="of how far around the search looks at first")
    parser.add_argument("-o", "--output", type=Path, default=Path("found.yaml"))
    args = parser.parse_args()
    root = args.passage.resolve().parents[2]
    body = lumen.load(root).body
    text = Text(args.passage.read_text("utf-8"), body)
    trials = [Trial(body, root / "models", Motion.load(args.passage), args.seed + i) for i in range(args.robots)]
    best, used = cost(text.written(text.numbers), trials, body), 1
    print(f"as it stands: {best:.4f}")
    options = {"seed": args.seed, "CMA_stds": text.reach, "verbose": -9}
    search = cma.CMAEvolutionStrategy(text.numbers, args.sigma, options)
    while used < args.evaluations:
        asked = search.ask()
        costs = [cost(text.written(numbers), trials, body) for numbers in asked]
        search.tell(asked, costs)
        used += len(asked)
        if min(costs) < best:
            best = min(costs)
            args.output.write_text(text.written(asked[int(np.argmin(costs))]), "utf-8")
        print(f"after {used} evaluations: {best:.4f}, this generation's middle {np.median(costs):.4f}", flush=True)


if __name__ == "__main__":
    main()
