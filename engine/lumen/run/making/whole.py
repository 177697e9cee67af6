"""Makers of visitor, robot and brain for an exhibition in one process."""

from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.language.stories import Story, TouchSensor
from lumen.ports import FeelsTouch, RobotCommand
from lumen.project.home import home_of
from lumen.robot.command_receiver import CommandListener
from lumen.robot.deduplication_log import DEDUPLICATION_FILE
from lumen.run.live_behavior import LiveBehavior
from lumen.run.parts.brain import BrainPart
from lumen.run.parts.foreign_commands import ForeignCommands
from lumen.run.parts.kept_hold import KeptHold
from lumen.run.parts.robot import RobotPart, RunBefore
from lumen.run.parts.visitor import VisitorPart
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.services import Services


def behavior(services: Services) -> None:
    """Provide the behaviour, which moves the robot of this process."""

    def refuse(command: RobotCommand) -> str:
        return services[RobotPart].server.hold.admit(command, behavior=True)

    plan = services.plan
    published = not plan.silent
    found = LiveBehavior(
        plan.project,
        services.setup,
        services.bus,
        plan.story,
        published=published,
        adopt=services.node.use,
        refuse=refuse,
    )
    services.provide(found)


def visitor(services: Services) -> VisitorPart | None:
    """Make the visitor in the hall around the robot; None if there is no hall.

    Raises UsageError if a story needs a hall, or a touch sensor, that the robot lacks.
    """
    hall, story = services.setup.hall, services.plan.story
    if story and hall is None:
        raise UsageError(f"the story `{story.name}` needs a robot with the methods `place` and `face`: docs/python.md")
    if story and _touches(story) and not isinstance(hall, FeelsTouch):
        raise UsageError(f"the story `{story.name}` touches the robot, which needs the method `touch`: docs/python.md")
    if hall is None:
        return None
    loop, tell = services.behavior.loop, services.narrator.visitor_action
    return VisitorPart(services.project, services.bus, hall, loop, story, tell)


def robot(services: Services) -> RobotPart:
    """Make the robot, which is notified of the behaviour's steps before the narrator."""
    plan, options = services.plan, services.plan.options
    directory = options.get("directory")
    record = directory.records.write if directory and services.lasts else lambda _: None
    listeners = (ForeignCommands(services.narrator, record), _Noticing(services.behavior))
    begun = directory and plan.shared and home_of(directory.root, plan.project.one_of_several) / DEDUPLICATION_FILE
    return RobotPart(
        services.project,
        services.bus,
        services.setup,
        listeners,
        services.presence,
        silent=plan.silent,
        before=RunBefore(KeptHold(directory.home.folder) if directory and services.lasts else None, begun or None),
    )


def narrator(services: Services) -> None:
    """Subscribe the player of the story, then the narrator, to the behaviour's steps."""
    visitor = services.get(VisitorPart)
    player = visitor.player if visitor else None
    services.behavior.loop.observers += [*([player] if player else []), services.narrator]


def brain(services: Services) -> BrainPart:
    """Make the part that steps the behaviour."""

    def recover() -> Resumption | FreshStart:
        from lumen.run.making.serving import recovered  # not needed by rehearsals, which resume nothing

        return recovered(services)

    hold = services[RobotPart].server.hold
    how = recover if services.plan.options.get("directory") else FreshStart
    return BrainPart(services.behavior, services.narrator, services.presence, services.plan.language, hold, how)


class _Noticing(CommandListener):
    """A listener that raises an event in the behaviour when a person stops the robot."""

    def __init__(self, behavior: LiveBehavior) -> None:
        self._behavior = behavior

    def noticed(self, event: Event) -> None:
        self._behavior.loop.happen(event)


def _touches(story: Story) -> bool:
    return any(isinstance(step.action, TouchSensor) for step in story.steps)
