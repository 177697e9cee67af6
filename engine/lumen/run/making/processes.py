"""Makers of the parts of one process of several."""

from pathlib import Path

from lumen.language.projects import Project
from lumen.motion.bounds import analyse
from lumen.robot.person_hold import StoppedBy
from lumen.run.live_behavior import LiveBehavior
from lumen.run.making.serving import recovered
from lumen.run.parts.hosted_robot import HostedRobotPart, stopped_there
from lumen.run.parts.motion import MotionPart
from lumen.run.parts.remote_brain import RemoteBody, RemoteBrainPart, RemoteHold
from lumen.run.parts.visitor import RemoteVisitorPart
from lumen.run.presence import Presence
from lumen.run.processes.bundles import BundleFollower
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.services import Services
from lumen.run.story import staged


def follower(services: Services) -> BundleFollower:
    """Make the part that loads the bundles which the brain's process activates."""
    project = services.plan.project
    root, tell = Path(project.root), services.tell("reload")
    return BundleFollower(root, project, services.bus, services.node.use, tell)


def behavior(services: Services) -> None:
    """Provide the behaviour, with a body and a hold that control a robot over the bus."""
    plan, bus, presence = services.plan, services.bus, _presence(services)
    body = RemoteBody(staged(plan.project, plan.story), bus, services.clock, presence)

    def adopt(bundle: Project) -> None:
        body.robot.use(bundle)
        services.node.use(bundle)

    def stopped() -> StoppedBy | None:
        robot = services.get(HostedRobotPart)
        return robot.server.hold.stopped if robot else stopped_there(presence)

    hold = RemoteHold(stopped)
    services.provide(body, hold, body.behavior(plan.project, bus, plan.story, plan.speed, adopt, hold.refuse))


def robot(services: Services) -> HostedRobotPart:
    """Make a robot for a brain that reaches it over the bus, from another process or from this one."""
    noticed = services.noticed if not services.plan.brain else lambda _: None
    project, bus, setup = services.plan.project, services.bus, services.setup
    analyse(project.motions.values(), project.body)  # now, so that the first motion starts without a delay
    return HostedRobotPart(project, bus, setup, _presence(services), services.narrator, noticed)


def motion(services: Services) -> MotionPart:
    """Make the motion module."""
    project, bus, clock = services.plan.project, services.bus, services.clock
    return MotionPart(project, bus, clock, _presence(services), services.narrator)


def narrator(services: Services) -> None:
    """Subscribe the narrator, then the predictor of the robot's refusals, to the behaviour's steps."""
    services.behavior.loop.observers += [services.narrator, services[RemoteHold]]


def brain(services: Services) -> RemoteBrainPart:
    """Make the part that steps the behaviour."""
    directory: RunDirectory = services.plan.options["directory"]
    return RemoteBrainPart(
        services[LiveBehavior],
        services[RemoteBody],
        services.narrator,
        _presence(services),
        directory.home,
        services.plan.language,
        lambda: recovered(services),
    )


def visitor(services: Services) -> RemoteVisitorPart:
    """Make a visitor in the hall of another process."""
    plan = services.plan
    telling = not plan.brain
    return RemoteVisitorPart(plan.project, services.bus, services.narrator, plan.story, telling=telling)


def _presence(services: Services) -> Presence:
    if services.presence is None:
        raise LookupError("a process of several needs a presence on the bus")
    return services.presence
