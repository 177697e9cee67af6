"""Searches for the numbers with which a biped walks best, and prints them as `gait` of its `models/NAME.yaml`.

    python scripts/search_gait.py NAME [--pace usual|brisk] [--tries 40] [--robots 3] [--seconds 8] [--seed 0] [--write]

It begins with the numbers of `models/NAME.yaml`, or with those that follow from the legs by rule, and draws each try
near the best one so far, with a shrinking spread: a random search, as for NAO's brisk pace (docs/decisions/074). Robots
differ in their masses, floors and noise. The score of a try is the distance walked in the given time, minus the
sideways error; it is 0 if any robot falls. Two tries run at once (`--workers 1`: one after the other, with the same
result). Tries are stored in `.cache/search_gait/` by everything they depend on, the file's content and the software:
after a restart the search continues. `--write` puts the best numbers into the file, and another search begins there.
"""

import argparse
import json
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.features.simulation.bodies import shipped  # noqa: E402
from tests.features.simulation.walks import any_robot, truth  # noqa: E402

from lumen.errors import LumenError, UsageError  # noqa: E402
from lumen.features.simulation.falling_sense import MassModel  # noqa: E402
from lumen.features.simulation.leg_geometry import read_legs  # noqa: E402
from lumen.language.commands import Move  # noqa: E402
from lumen.motion.gait import GaitParameters, paces_of  # noqa: E402
from lumen.project.bodies import GAIT_ANGLES, GAIT_LENGTHS  # noqa: E402
from lumen.project.units import ANGLES, LENGTHS  # noqa: E402
from lumen.run.workers.tasks import (  # noqa: E402
    UnpackedKit,
    WorkKit,
    engine,
    name_of,
)
from lumen.run.workers.workers import Workers, workers_of  # noqa: E402

MODELS, CACHE = ROOT / "models", ROOT / ".cache" / "search_gait"

SEARCHED = {
    "usual": ("double", "single", "forward", "lift", "torso", "lean", "ahead", "inside"),
    "brisk": ("double", "single", "forward", "lift", "ahead", "inside"),
}
"""The parameters to draw. A brisk walk carries the torso at the usual height, because a walk can change its pace."""

SPREAD, NARROWS = 0.12, 0.97
"""The spread of tries around the best one, relative to each number, and its factor after each try."""

AT_ONCE = 2
FASTER = {"usual": 0.98, "brisk": 10.0}
"""The requested speed, relative to the pace's own: `brisk` is used if the usual pace is too slow."""

BEGINS = 1.5
"""The time that a robot needs to shift its weight and begin, before its distance counts [s]."""


class Try(NamedTuple):
    """The numbers of a try, its score, and the number of robots that did not fall.

    The score is the mean distance of all robots [m], minus sideways errors; 0 if a robot fell.
    """

    numbers: dict[str, float]
    score: float
    upright: int


def tried(kit: UnpackedKit, name: str, pace: str, numbers: dict[str, float], robots: int, seconds: float) -> Try:
    """Let robots walk with these numbers, as a task of a worker; the body is in this repository."""
    body = shipped(name)
    body = replace(body, gait={**body.gait, pace: {**body.gait.get(pace, {}), **numbers}})
    paces = paces_of(read_legs(MassModel(body, MODELS).model, body), body.gait)
    asked = getattr(paces, pace)
    speed = FASTER[pace] * asked.forward / (asked.double + asked.single)
    ways, upright = 0.0, 0
    for seed in range(robots):
        robot = any_robot(body, seed)
        robot.start("walk", Move(speed, 0.0, 0.0))
        robot.advance(BEGINS)
        before = truth(robot)
        robot.advance(seconds)
        way = truth(robot).seen_from(before)
        upright += not robot.fallen
        ways += 0.0 if robot.fallen else way.x - abs(way.y)
    return Try(numbers, ways / robots if upright == robots else 0.0, upright)


def drawn(best: dict[str, float], count: int, random: np.random.Generator) -> dict[str, float]:
    """Return numbers near the best ones."""
    spread = SPREAD * NARROWS**count
    return {name: round(value * (1 + spread * random.standard_normal()), 4) for name, value in best.items()}


def search(options: argparse.Namespace, workers: Workers, cache: Path = CACHE) -> Try:
    """Make and print one try after another, from the end of the last search; return the best."""
    if workers.address:
        raise UsageError("--workers of this search are processes of this machine: write a number")
    body = shipped(options.model)
    start: GaitParameters = getattr(paces_of(read_legs(MassModel(body, MODELS).model, body), body.gait), options.pace)
    content = json.dumps([engine(), (MODELS / f"{options.model}.yaml").read_text("utf-8")]).encode()
    run = f"{options.model}-{options.pace}-{options.robots}-{options.seconds:g}-{options.seed}"
    kept = cache / f"{run}-{name_of(content)}.jsonl"
    kept.parent.mkdir(parents=True, exist_ok=True)
    tries = [Try(**json.loads(line)) for line in kept.read_text().splitlines()] if kept.exists() else []
    numbers = {name: value for name, value in asdict(start).items() if name in SEARCHED[options.pace]}
    with workers.crew(tried, WorkKit({}, {}), AT_ONCE) as crew, kept.open("a", encoding="utf-8") as record:
        while len(tries) < options.tries:
            random = np.random.default_rng((options.seed, len(tries)))
            best = max(tries, key=lambda one: one.score, default=Try(numbers, 0.0, 0))
            wanted = [drawn(best.numbers, len(tries), random) for _ in range(AT_ONCE)]
            if not tries:
                wanted[0] = numbers
            tasks = [(options.model, options.pace, one, options.robots, options.seconds) for one in wanted]
            for _, one in sorted(crew.results(tasks)):
                tries.append(one)
                record.write(json.dumps(one._asdict()) + "\n")
                record.flush()
                print(f"{len(tries):3d}  {one.upright} of {options.robots} upright  {one.score:6.3f} m", flush=True)
    first, best = tries[0], max(tries, key=lambda one: one.score)
    print(f"{options.pace}: {first.score:.3f} m at first, {best.score:.3f} m at best, in {options.seconds:g} s")
    return best


def written(text: str, pace: str, numbers: dict[str, float]) -> str:
    """Return the text of a body's file with these numbers [m], [rad], [s] in its `gait`, which must be at its end."""
    head, _, tail = text.partition("\ngait:\n")
    kept: dict[str, Any] = yaml.safe_load(f"gait:\n{tail}")
    if kept.keys() != {"gait"}:
        raise SystemExit("`gait` does not stand at the end of the file: move it there")
    units = yaml.safe_load(head).get("units") or {}
    angle, length = ANGLES[units.get("angle", "rad")], LENGTHS[units.get("length", "m")]
    sizes = {**dict.fromkeys(GAIT_ANGLES, angle), **dict.fromkeys(GAIT_LENGTHS, length)}
    gait: dict[str, dict[str, float]] = kept["gait"] or {}
    gait[pace] = {**gait.get(pace, {}), **{name: value / sizes.get(name, 1.0) for name, value in numbers.items()}}
    lines = [f"  {name}: {{{', '.join(f'{k}: {v:g}' for k, v in found.items())}}}" for name, found in gait.items()]
    return head.rstrip("\n") + "\n\ngait:\n" + "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("model", help="the body in models/")
    parser.add_argument("--pace", choices=FASTER, default="usual")
    parser.add_argument("--tries", type=int, default=40, help="in all, those of before counted")
    parser.add_argument("--robots", type=int, default=3, help="for each try")
    parser.add_argument("--seconds", type=float, default=8.0, help="that they walk")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--write", action="store_true", help="put the best into models/NAME.yaml")
    parser.add_argument("--workers", metavar="N", default=str(AT_ONCE), help=f"processes (default: {AT_ONCE})")
    options = parser.parse_args()
    try:
        best = search(options, workers_of(options.workers))
    except LumenError as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit(130)
    file = MODELS / f"{options.model}.yaml"
    text = written(file.read_text("utf-8"), options.pace, best.numbers)
    if options.write:
        file.write_text(text, "utf-8")
    print(text[text.index("\ngait:\n") + 1 :], end="")


if __name__ == "__main__":
    main()
