"""Searches a better passage from the one in a file, with CMA-ES in simulation (`pip install 'lumen-robot[search]'`):

    python scripts/search_passage.py models/passages/straddle-crouch.yaml --evaluations 500 --robots 4 -o found.yaml

What may change are the numbers of the file: the angles of its poses, in whole degrees, and the times between its
keyframes. What is written is the same file with other numbers; the posture that it ends in stays as it is. All cores
work (`--workers N`, or a cluster). What each passage costs is kept in `.cache/search_passage/` by the content of all
that it hangs on: the same command goes on where it was ended.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from itertools import pairwise
from math import ceil, floor, radians
from pathlib import Path

import mujoco
import numpy as np
import yaml

import lumen
from lumen.errors import LumenError
from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.world import CONTROL_PERIOD
from lumen.language.commands import Posture
from lumen.language.robots import Body
from lumen.motion import Motion
from lumen.motion.limits import beyond_limits, overspeed
from lumen.motion.trajectories import Trajectory
from lumen.project.files import read_files
from lumen.project.lending import MODELS
from lumen.run.workers.tasks import UnpackedKit, WorkKit, engine, models_in, name_of
from lumen.run.workers.workers import Workers, workers_of

CACHE = Path(__file__).parent.parent / ".cache" / "search_passage"

MISS, EFFORT, BUMP, TIME, BEYOND, WORST = 2.0, 0.4, 1.0, 0.01, 1.0, 0.3
"""The price of the torso's final direction error, of the mean cubed load of the motors, of sinking faster than `GENTLE`
[m/s], of each second, and of each radian (per second) beyond the body's limits. The cost is the robots' mean plus
`WORST` times the worst of them.
"""

GENTLE, SETTLING = 0.3, 1.0

ANGLE, TIMES = 8.0, 0.15
"""The initial spread of the search: [degrees], [s]."""

_ANGLE, _TIME = re.compile(r"\b([LRH]\w+): (-?\d+)(?=[,}])"), re.compile(r"(?<=at: )[\d.]+(?=s)")


class Text:
    """The text of a passage as `numbers`: first the `angles` of its poses [degrees], then times between keyframes [s].

    `reach` is the initial spread of the search for each of them.
    """

    def __init__(self, text: str, body: Body) -> None:
        self._text = text
        self._joints = [body.joints[name] for name, _ in _ANGLE.findall(text)]
        self.angles = len(self._joints)
        times = [0.0, *map(float, _TIME.findall(text))]
        self.numbers = [float(angle) for _, angle in _ANGLE.findall(text)] + [b - a for a, b in pairwise(times)]
        self.reach = [ANGLE] * self.angles + [TIMES] * (len(times) - 1)

    def written(self, numbers: Sequence[float]) -> str:
        """Return the passage with these numbers, inside the joints' limits and at least 0.05 s between keyframes."""
        angles = iter(
            min(max(round(number), ceil(joint.minimum / radians(1))), floor(joint.maximum / radians(1)))
            for joint, number in zip(self._joints, numbers[: self.angles], strict=True)
        )
        times = iter(np.cumsum(np.maximum(numbers[self.angles :], 0.05)).tolist())
        text = _ANGLE.sub(lambda match: f"{match[1]}: {next(angles)}", self._text)
        return _TIME.sub(lambda _: f"{next(times):.2f}", text)


class Trial:
    """A robot with its own weight and floor, standing in the posture in which a passage begins."""

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
        """Return the cost of this passage with this robot."""
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
    """Return the cost of a passage: the robots' mean, the worst of them, and the excess over the body's limits."""
    motion = Motion.from_dict(yaml.safe_load(text), "passage")
    beyond = sum(abs(e.value - e.limit) for e in (*beyond_limits(motion, body), *overspeed(motion, body)))
    costs = [trial.cost(motion) for trial in trials]
    return float(np.mean(costs)) + WORST * max(costs) + BEYOND * beyond


class KeptCosts:
    """The costs of passages, in a separate file for each project, software and choice of robots."""

    def __init__(self, folder: Path, *content: str) -> None:
        self._file = folder / f"{name_of(json.dumps([engine(), *content]).encode())}.jsonl"
        folder.mkdir(parents=True, exist_ok=True)
        text = self._file.read_text("utf-8") if self._file.exists() else ""
        whole, _, torn = text.rpartition("\n")
        if torn:  # the program was ended during a write
            self._file.write_text(f"{whole}\n" if whole else "", "utf-8")
        self._known: dict[str, float] = dict(map(json.loads, whole.splitlines()))

    def of(self, texts: Sequence[str], compute: Callable[[list[str]], Iterable[tuple[int, float]]]) -> list[float]:
        """Return the cost of each text; unknown ones are computed, and stored at once."""
        unknown = list(dict.fromkeys(text for text in texts if _name(text) not in self._known))
        with self._file.open("a", encoding="utf-8") as file:
            for number, found in compute(unknown):
                self._known[_name(unknown[number])] = found
                file.write(json.dumps([_name(unknown[number]), found]) + "\n")
                file.flush()
        return [self._known[_name(text)] for text in texts]


def _name(text: str) -> str:
    return name_of(text.encode())


def cost_of(kit: UnpackedKit, text: str, passage: str, robots: int, seed: int) -> float:
    """Return the cost of a passage with that many robots, which begin like the one in `passage`; a task of a worker."""
    body, trials = _trials(kit, passage, robots, seed)
    return cost(text, trials, body)


@cache
def _trials(kit: UnpackedKit, passage: str, robots: int, seed: int) -> tuple[Body, list[Trial]]:
    """Return the robots, made once in each process, because it takes long to bring them to their initial posture."""
    project = kit.project()
    assert project is not None  # the sender of the tasks has loaded it
    motion = Motion.from_dict(yaml.safe_load(passage), "passage")
    return project.body, [Trial(project.body, kit.root / MODELS, motion, seed + i) for i in range(robots)]


def searched(args: argparse.Namespace, workers: Workers, kept: Path) -> float:
    """Search, and write each better passage; return the cost of the best one."""
    import cma  # only the search needs it

    root, passage = args.passage.resolve().parents[2], args.passage.read_text("utf-8")
    text = Text(passage, lumen.load(root).body)
    options = {"seed": args.seed, "CMA_stds": text.reach, "verbose": -9}
    search = cma.CMAEvolutionStrategy(text.numbers, args.sigma, options)
    kit, given = WorkKit({"": read_files(root)}, models_in(root)), (passage, args.robots, args.seed)
    costs = KeptCosts(kept, name_of(kit.packed()), *map(str, given))
    with workers.crew(cost_of, kit, search.popsize) as crew:

        def compute(texts: list[str]) -> Iterable[tuple[int, float]]:
            return crew.results((one, *given) for one in texts)

        (best,), used = costs.of([text.written(text.numbers)], compute), 1
        print(f"as it stands: {best:.4f}", flush=True)
        while used < args.evaluations:
            asked = search.ask()
            texts = [text.written(numbers) for numbers in asked]
            found = costs.of(texts, compute)
            search.tell(asked, found)
            used += len(asked)
            if min(found) < best:
                best = min(found)
                args.output.write_text(texts[int(np.argmin(found))], "utf-8")
            middle = np.median(found)
            print(f"after {used} evaluations: {best:.4f}, this generation's middle {middle:.4f}", flush=True)
    return best


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("passage", type=Path)
    parser.add_argument("--evaluations", type=int, default=500)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sigma", type=float, default=0.5, help="of how far around the search looks at first")
    parser.add_argument("--workers", metavar="N", help="processes, or a cluster: dask://HOST:8786 (default: all cores)")
    parser.add_argument("-o", "--output", type=Path, default=Path("found.yaml"))
    args = parser.parse_args()
    try:
        searched(args, workers_of(args.workers), CACHE)
    except LumenError as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
