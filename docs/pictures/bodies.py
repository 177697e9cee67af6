"""Make bodies.png and reachy_mini.png with simulated physics.

bodies.png shows each body that comes with Lumen, except NAO, in the middle of a motion. reachy_mini.png shows four
moments of Reachy Mini.

    python docs/pictures/bodies.py [--sheets FOLDER]

`--sheets` draws six moments of each motion of each body into that folder, for people who work on the motions.
"""

import argparse
import sys
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image

import lumen
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.features.simulation.rendering import RenderQuality, RenderState, SceneRenderer
from lumen.language.projects import Project
from lumen.ports import Perform
from lumen.project.chosen_model import choose
from lumen.project.lending import model_files

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
SHOWN = {
    "greeter": ("goodbye", 2.0, 0.62, 2.7),
    "sprout": ("dance", 8.0, 0.2, 0.95),
    "lantern": ("goodbye", 0.9, 0.18, 0.85),
    "reachy_mini": ("goodbye", 1.3, 0.16, 0.72),
}
"""For each body: a motion, the time in it [s], the height of the body's middle and the distance of the camera [m]."""
REACHY = (("greet", 1.4), ("curious", 1.4), ("goodbye", 1.4), ("sleepy", 5.8))
CROP = 40, 120, 380, 480
FLOOR, AROUND, DOWN = 0.5, 24.0, -8.0
SIZE = 420, 520
MOMENTS = 6


def robot_of(name: str) -> tuple[Project, SimulatedRobot]:
    choose(name)
    project = lumen.load(ROOT)
    models, hall = model_files(project)
    return project, SimulatedRobot(project.body, models, hall, stage=project.stage)


def shot(robot: SimulatedRobot, middle: float, away: float, size: tuple[int, int] = SIZE) -> Image.Image:
    """Return a picture of the robot in its hall, in its present pose."""
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = 0.0, 0.0, FLOOR + middle
    camera.distance, camera.azimuth, camera.elevation = away, 180.0 + AROUND, DOWN
    studio = SceneRenderer(robot.world.model, RenderQuality(shadows=4096, samples=4))
    pixels = studio.draw(RenderState.of(robot.world.model, robot.world.data), camera, *size)
    studio.close()
    return Image.fromarray(pixels)


def moments(name: str, motion: str, at: list[float]) -> list[Image.Image]:
    """Return pictures of the body at these times [s] of a motion."""
    project, robot = robot_of(name)
    robot.advance(0.5)
    robot.start("c", Perform(project.motions[motion]))
    shots, before = [], 0.0
    for time in at:
        robot.advance(time - before)
        shots.append(shot(robot, *SHOWN[name][2:]))
        before = time
    robot.close()
    return shots


def row(shots: list[Image.Image]) -> Image.Image:
    width, height = shots[0].size
    whole = Image.new("RGB", (width * len(shots), height))
    for i, one in enumerate(shots):
        whole.paste(one, (width * i, 0))
    return whole


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sheets", metavar="FOLDER", type=Path)
    sheets = parser.parse_args().sheets
    if reason := available():
        sys.exit(reason)
    if sheets is None:
        shown = {name: moment for name, moment in SHOWN.items() if name != "reachy_mini"}
        shots = [moments(name, motion, [at])[0] for name, (motion, at, *_) in shown.items()]
        row(shots).save(HERE / "bodies.png", optimize=True)
        reachy = [moments("reachy_mini", motion, [at])[0].crop(CROP) for motion, at in REACHY]
        row(reachy).save(HERE / "reachy_mini.png", optimize=True)
        return
    for name in SHOWN:
        choose(name)
        for motion, course in lumen.load(ROOT).motions.items():
            at = np.linspace(0.6, course.duration - 0.2, MOMENTS).tolist()
            row(moments(name, motion, at)).resize((1260, 260)).save(sheets / f"{name}_{motion}.png")
            print(f"{name} {motion}: done")


if __name__ == "__main__":
    main()
