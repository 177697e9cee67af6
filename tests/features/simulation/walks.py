"""Walks on a floor with room for them, and their errors at the end."""

from dataclasses import dataclass
from functools import cache
from math import atan2, cos, degrees, hypot, pi, radians, sin, tan
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import mujoco
import numpy as np

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Walk
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.motion.gait import SIDES, Feet, Pose, Side, middle
from lumen.motion.gait.legs import SIDE_ROLES
from tests.features.simulation.conftest import MODELS, answer

START = (3.0, -3.0)
"""The place of these robots on the hall's floor [m], with two metres around them."""

TARGETS = (Walk(0.2), Walk(0.5), Walk(0.0, 0.2), Walk(0.0, 0.0, pi / 2), Walk(0.3, 0.2, pi / 4))
SLOPE = 2.0
"""The length of a slope [m]."""

LONGEST = 120.0
"""The longest time that a walk may take [s]."""

RESTED = 12.0
"""The time after which a standing robot knows its gyrometer's bias [s]."""

NEAR, STRAIGHT = 1.5, 1.5
"""The largest allowed errors at the end of a walk: distance [cm] and direction [degrees]."""


@dataclass
class Walked:
    """The end of a walk: its answer, its distance from the target [cm, degrees], the greatest tilt [degrees]."""

    answer: str
    events: list[Event]
    seconds: float
    off: float
    turned: float
    tilt: float

    @property
    def true(self) -> bool:
        return self.answer == "done" and self.off < NEAR and abs(self.turned) < STRAIGHT

    @property
    def upright(self) -> bool:
        return self.answer == "done" and self.tilt < 45


@cache
def floor(more: str = "") -> str:
    """Return the path of the shipped hall, with its robot on the floor and the geoms `more` (MJCF)."""
    folder = Path(mkdtemp())
    (folder / "hall").symlink_to(MODELS / "hall")
    text = (MODELS / "hall.xml").read_text("utf-8")
    moved = text.replace('name="stage" pos="0 0 0.5"', f'name="stage" pos="{START[0]} {START[1]} 0"')
    assert moved != text
    (folder / "floor.xml").write_text(moved.replace("<worldbody>", f"<worldbody>{more}", 1), "utf-8")
    return str(folder / "floor.xml")


def on_the_floor(body: Body, more: str = "", **options: Any) -> SimulatedRobot:
    return SimulatedRobot(body, MODELS, floor(more), **options)


def any_robot(body: Body, seed: int, posture: str = "Stand", more: str = "") -> SimulatedRobot:
    """Return a robot with links up to 10 % lighter or heavier, each by its own, on a floor of friction 0.5 to 1.0."""
    draw = np.random.default_rng(seed)
    friction = draw.uniform(0.5, 1.0) / 0.8
    robot = on_the_floor(body, more, seed=seed, posture=posture)
    model = robot.world.model
    model.geom_friction *= friction
    for i in range(model.nbody):
        if model.body(i).name.startswith(f"{ROBOT_PREFIX}/"):
            factor = draw.uniform(0.9, 1.1)
            model.body_mass[i] *= factor
            model.body_inertia[i] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))
    robot.advance(0.3)
    return robot


def feet(robot: SimulatedRobot) -> Feet:
    """Return the true poses of both feet, relative to the robot's start."""
    found: dict[Side, Pose] = {}
    for side in SIDES:
        site = robot.world.data.site(f"{ROBOT_PREFIX}/{robot.body.roles.soles[SIDE_ROLES[side]]}")
        axes = site.xmat.reshape(3, 3)
        found[side] = Pose(site.xpos[0] - START[0], site.xpos[1] - START[1], atan2(axes[1, 0], axes[0, 0]))
    return found


def truth(robot: SimulatedRobot) -> Pose:
    """Return the true pose of the midpoint between the robot's feet, relative to its start."""
    return middle(feet(robot))


def ramp(degrees: float) -> str:
    """Return a slope that begins 0.3 m ahead of the robot, as MJCF."""
    angle = radians(degrees)
    x, height = START[0] + 0.3 + SLOPE / 2, SLOPE / 2 * tan(angle)
    return (
        f'<geom class="ground" type="box" size="{SLOPE / 2} 0.6 0.005" pos="{x} {START[1]} {height - 0.005}" '
        f'euler="0 {-angle} 0"/>'
    )


def bump(height: float) -> str:
    """Return rails of that height [m] across the robot's way, 3 cm wide and 13 cm apart, as MJCF."""
    return "".join(
        f'<geom class="ground" type="box" size="0.015 0.6 {height / 2}" pos="{START[0] + 0.2 + 0.13 * k} {START[1]} '
        f'{height / 2}"/>'
        for k in range(6)
    )


def strayed(robot: SimulatedRobot) -> float:
    """Return the distance between the robot's true position and its odometry's estimate [cm]."""
    there, where = truth(robot), robot.base.whereabouts
    return 100 * hypot(there.x - where.x, there.y - where.y)


@dataclass
class Push:
    """A push of so many newtons for 0.1 s, `at` seconds after the walk began, towards `to` [rad]."""

    newton: float = 0.0
    at: float = 0.0
    to: float = 0.0

    def act(self, robot: SimulatedRobot, now: float) -> None:
        on = self.newton if self.at <= now < self.at + 0.1 else 0.0
        robot.world.data.xfrc_applied[robot.world.torso][:2] = on * cos(self.to), on * sin(self.to)


def walk(robot: SimulatedRobot, command: Walk, push: Push | None = None) -> Walked:
    """Let the robot walk until the command is answered, and a moment more; return the end of the walk."""
    goal, begin = truth(robot).then(Pose(command.x, command.y, command.theta)), robot.time
    robot.start("walk", command)
    events: list[Event] = []
    while not answer(events, "walk") and robot.time < begin + LONGEST:
        if push:
            push.act(robot, robot.time - begin)
        robot.advance(0.01)
        events += robot.poll()
    took = robot.time - begin
    robot.advance(0.5)
    off = truth(robot).seen_from(goal)
    return Walked(
        answer(events, "walk"), events, took, 100 * hypot(off.x, off.y), degrees(off.theta), robot.greatest_tilt
    )
