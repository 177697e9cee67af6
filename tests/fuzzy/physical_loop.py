"""The loop of `closed_loop.py` with the simulated robot: its joints and the faces are messages on the bus."""

from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path

from lumen.bus import connect
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.settings import Imperfections
from lumen.language.commands import Look, Track
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.motion.projection import centring
from lumen.robot.server import RobotServer
from lumen.run.perception import FaceDetector
from lumen.run.tracking import LocalTracking
from tests.fuzzy.closed_loop import Pose, Run

TICK = 0.02
"""The tick of an exhibition [s]."""

SETTLING = 1.0
"""The time that the robot stands with its head turned away before the controller is switched on [s]."""


def run(
    project: Project,
    visitor: Callable[[float], Visitor],
    off: Pose = (0.0, 0.0),
    *,
    latency: float = 0.1,
    tick: float = 0.1,
    duration: float = 4.0,
    within: Callable[[float, float], Pose] = lambda yaw, pitch: (yaw, pitch),
    imperfections: Imperfections | None = None,
) -> Run:
    """Let the shipped controller follow a visitor; the head begins so far [deg] beside the pose that centres the face.

    The poses of the result are beside that pose too [rad], wherever face and torso are by then: they end at 0. Images
    are taken every `tick` [s] and published `latency` [s] later. `within` limits the first pose.
    The robot has these `imperfections`; None stands for all.
    """
    few = replace(project, routes={name: project.routes[name] for name in ("face", "joint")})
    models = Path(project.root) / "models"
    robot = SimulatedRobot(project.body, models, project.hall, stage=project.stage, imperfections=imperfections)
    bus = connect("memory://")
    server = RobotServer(few, robot, bus)
    robot.place(visitor(0.0))
    robot.advance(0.2)
    goal = towards_face(robot)
    robot.start("look", Look(*within(goal[0] + radians(off[0]), goal[1] + radians(off[1]))))
    robot.advance(SETTLING)
    robot.poll()
    tracking, faces = LocalTracking(few, robot, bus), FaceDetector(few, robot, bus, period=tick, latency=latency)
    tracking.switch(Track("head"))
    began, result = robot.time, Run([], [])
    while (now := robot.time) < began + duration:
        robot.place(visitor(now - began))
        server.sample(now)
        server.settle()
        faces.tick(now)
        tracking.tick(now)
        yaw, pitch = towards_face(robot)
        head = robot.world.angles
        result.poses.append((now - began, float(head[0]) - yaw, float(head[1]) - pitch))
        result.pixels.append(robot.face())
        robot.advance(TICK)
    server.close()
    bus.close()
    robot.close()
    return result


def towards_face(robot: SimulatedRobot) -> Pose:
    """Return the yaw and pitch [rad] that would bring the visitor's face to the middle of the image."""
    torso = robot.world.data.body("nao/Torso")
    face = robot.world.data.site("visitor_face").xpos
    x, y, z = torso.xmat.reshape(3, 3).T @ (face - torso.xpos)
    return centring((float(x), float(y), float(z)), robot.body.camera)
