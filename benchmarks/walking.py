"""Measure the walk of a simulated biped: its speed, its accuracy on several floors, and the error of its odometry.

    python benchmarks/walking.py [--robots N] [--model NAME]

Each robot differs from the model: every link is up to 10 % lighter or heavier, friction is 0.5 to 1.0, and sensors are
noisy. Speeds are requested by `move`, for 3 s of acceleration and 8 s of measurement. `off` is the distance of a
robot's end from its goal, `odometry` the distance from its estimate, each the worst of those still upright; a `rested`
robot has stood for 12 s before. 2 robots give an impression, 20 the published figures.
"""

import argparse
import sys
from collections.abc import Callable
from math import hypot, pi
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.features.simulation.bodies import shipped  # noqa: E402
from tests.features.simulation.walks import RESTED, any_robot, bump, ramp, strayed, truth, walk  # noqa: E402

from lumen.features.simulation.offers import SimulatedRobot  # noqa: E402
from lumen.language.commands import Move, Walk  # noqa: E402
from lumen.motion.gait import Pose  # noqa: E402

SECONDS = 8.0
Start = Callable[[int], SimulatedRobot]


def fast(name: str, start: Start, robots: int, command: Move, speed: Callable[[Pose], float]) -> None:
    """Print the speeds that robots reach for a requested speed."""
    reached = []
    for seed in range(robots):
        robot = start(seed)
        robot.start("it", command)
        robot.advance(3.0)
        before, turned, theta = truth(robot), 0.0, truth(robot).theta
        for _ in range(round(SECONDS / 0.1)):
            robot.advance(0.1)
            now = truth(robot).theta
            turned, theta = turned + (now - theta + pi) % (2 * pi) - pi, now
        way = truth(robot).seen_from(before)
        if not robot.fallen:
            reached.append(speed(Pose(way.x, way.y, turned)) / SECONDS)
    print(f"{name:<26} {len(reached):2d} of {robots} upright   {np.mean(reached or [0.0]):5.3f} on average", flush=True)


def far(name: str, start: Start, robots: int, command: Walk, rest: float = 0.0) -> None:
    """Print the errors of robots sent to a place after a `rest` [s], and the errors of their estimates."""
    upright, off, aside, wrong = 0, [0.0], [0.0], [0.0]
    for seed in range(robots):
        robot = start(seed)
        robot.advance(rest)
        walked = walk(robot, command)
        if not walked.upright:
            continue
        upright += 1
        there = truth(robot)
        off.append(walked.off)
        aside.append(100 * abs(there.y - command.y))
        wrong.append(strayed(robot))
    share = max(wrong) / hypot(command.x, command.y)
    print(
        f"{name:<26} {upright:2d} of {robots} upright   off {max(off):4.1f} cm, aside {max(aside):4.1f} cm,"
        f" odometry {max(wrong):4.1f} cm ({share:.1f} %)",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robots", type=int, default=2, help="how many for each row (20 for the figures)")
    parser.add_argument("--model", default="nao", help="the body in models/ (nao)")
    options = parser.parse_args()
    robots, body = options.robots, shipped(options.model)

    def on(more: str = "") -> Start:
        return lambda seed: any_robot(body, seed, more=more)

    fast("forward [m/s]", on(), robots, Move(1.0, 0.0, 0.0), lambda way: way.x)
    fast("aside [m/s]", on(), robots, Move(0.0, 1.0, 0.0), lambda way: way.y)
    fast("turning [rad/s]", on(), robots, Move(0.0, 0.0, 9.0), lambda way: way.theta)
    far("0.5 m straight", on(), robots, Walk(0.5))
    far("5 m straight", on(), robots, Walk(5.0))
    far("5 m straight, rested", on(), robots, Walk(5.0), RESTED)
    far("over rails of 5 mm", on(bump(0.005)), robots, Walk(1.2))
    far("up 5 degrees", on(ramp(5.0)), robots, Walk(1.0))


if __name__ == "__main__":
    main()
