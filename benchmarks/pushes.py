"""Measure which pushes the simulated NAO withstands: standing, walking and dancing.

    python benchmarks/pushes.py [--robots N]

Each robot differs from the model: every link is up to 10 % lighter or heavier, friction is 0.5 to 1.0, and sensors are
noisy. A push is a force on the torso for 0.1 s; the robot must not fall within 3 s. 4 robots give an impression, 20 the
published figures.
"""

import argparse
import sys
from math import degrees
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.features.simulation.pushes import (  # noqa: E402
    DIRECTIONS,
    Doing,
    PushTrial,
    anywhere,
    dancing,
    standing,
    upright,
    walking,
    walking_briskly,
)

import lumen  # noqa: E402


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robots", type=int, default=4, help="how many for each row (20 for the figures)")
    robots = parser.parse_args().robots
    project = lumen.load(ROOT)
    body, dance = project.body, project.motions["dance"]
    whole = 0
    for to in DIRECTIONS:
        stood = sum(upright(body, standing, PushTrial(seed, 2.0, to)) for seed in range(robots))
        whole += stood
        print(f"2 N s, standing, towards {degrees(to):3.0f} deg   {stood:3d} of {robots}", flush=True)
    print(f"2 N s, standing, all directions     {whole:3d} of {robots * len(DIRECTIONS)}", flush=True)
    rows: list[tuple[str, Doing, tuple[float, float]]] = [
        ("standing", standing, (0.1, 0.1)),
        ("walking at 0.1 m/s", walking, (1.3, 4.5)),
        ("walking at 0.2 m/s", walking_briskly, (3.0, 6.0)),
        ("dancing", dancing(dance), (0.5, dance.duration)),
    ]
    for impulse in (2.0, 3.0):
        for name, doing, moments in rows:
            stood = sum(upright(body, doing, trial) for trial in anywhere(robots, impulse, moments))
            print(f"{impulse:g} N s, {name:<18}, anywhere   {stood:3d} of {robots}", flush=True)


if __name__ == "__main__":
    main()
