"""One process of several: the parts that it is, put together."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from lumen.app.alerts.desk import AlertDesk
from lumen.app.claiming import presence_of
from lumen.app.fleet.part import fleet_part
from lumen.app.narrator import Narrator
from lumen.app.node import Node
from lumen.app.parts.alerting import AlertPart
from lumen.app.parts.forgetting import ForgettingPart
from lumen.app.parts.hosted_robot import HostedRobotPart, stopped_there
from lumen.app.parts.module import ModulePart
from lumen.app.parts.module_troubles import ModuleTroublesPart
from lumen.app.parts.motion import MotionPart
from lumen.app.parts.operating import OperatorPart
from lumen.app.parts.recording import RecordingPart
from lumen.app.parts.remote_brain import RemoteBody, RemoteBrainPart
from lumen.app.parts.visitor import RemoteVisitorPart
from lumen.app.processes.bundles import BundleFollower
from lumen.app.recovery.recording import record_inputs
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.reload.alerting import RefusalPart
from lumen.app.reload.saved_files import RecordsPart, ReloadPart
from lumen.app.setup import Setup
from lumen.buses.validated import ValidatedBus
from lumen.interpreters.bounds import analyse
from lumen.language.modules import MODULES
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.robots.person_hold import StoppedBy
from lumen.runtime.home import home_of
from lumen.runtime.presence import BRAIN, MOTION, VISITOR, Presence
from lumen.runtime.resuming import FreshStart, Resumption
from lumen.runtime.story import staged


@dataclass(frozen=True)
class ProcessOptions:
    """How a process takes part: `speed` times real time, saved files taken as `reload` says, `fresh` or not."""

    url: str
    speed: float = 1.0
    reload: str = "auto"
    language: str = ""
    fresh: bool = False


@dataclass(frozen=True, slots=True)
class Plan:
    """What one process of several is made of; `names` are its parts."""

    project: Project
    names: Sequence[str]
    bus: ValidatedBus
    clock: Clock
    narrator: Narrator
    directory: RunDirectory
    options: ProcessOptions
    setup: Setup | None = None
    """Its robot, if it has one."""
    story: Story | None = None
    alerts: AlertDesk | None = None
    """Whom it tells of what goes wrong; it is closed with the process."""
    record: Path | None = None
    """The file into which the messages on the bus are recorded."""


def assemble(plan: Plan) -> Node:
    """Put a process together; the one that has the brain also records the last minutes."""
    project, names, bus, narrator, story = plan.project, plan.names, plan.bus, plan.narrator, plan.story
    robot: HostedRobotPart | None = None

    def said() -> dict[str, Any]:
        follows = robot.follows if robot else ""
        body = {"bundle": node.project.hash, "speed": plan.options.speed, "follows": follows}
        body |= robot.said if robot else {}
        return {**body, "time": round(node.now, 3), "realtime": node.pace.realtime} if robot else body

    presence = presence_of(project, bus, tuple(names), said)
    node = Node(project, bus, plan.clock, narrator, presence=presence, speed=plan.options.speed)
    if plan.setup or BRAIN in names:
        analyse(project.motions.values(), project.body)
    folder, records = home_of(plan.directory.root, project.one_of_several), plan.directory.records

    def kept() -> str:
        return records.trouble or recording.trouble

    def stopped() -> bool:
        return robot is not None and robot.stopped()

    alone = {} if BRAIN in names else {"stopped": stopped}
    watch = AlertPart(plan.alerts, bus, folder, names, presence, kept, **alone) if plan.alerts else None
    ring = plan.directory.home is not None and story is None
    recording = RecordingPart(project, bus, partial(narrator.line, "recording"), plan.record, ring=ring)
    node.parts += [recording, *([watch] if watch else [])]
    if plan.setup:
        noticed = watch.noticed if watch and BRAIN not in names else lambda _: None
        robot = HostedRobotPart(project, bus, plan.setup, presence, narrator, noticed)
        node.parts.append(robot)
        if BRAIN not in names:
            node.parts.append(ForgettingPart(project, bus, robot.forget))
    if MOTION in names:
        node.parts.append(MotionPart(project, bus, plan.clock, presence, narrator))
    if BRAIN in names:
        _add_brain(plan, node, presence, robot, watch, recording)
    if VISITOR in names:
        node.parts.append(RemoteVisitorPart(project, bus, narrator, story, telling=BRAIN not in names))
    node.parts += [ModulePart(name, project, bus, narrator.line, folder) for name in names if name in MODULES]
    if BRAIN not in names:
        root = Path(project.root)
        follower = BundleFollower(root, project, bus, node.use, lambda line: narrator.line("reload", line))
        node.before.append(follower.tick)
        node.closing.append(follower.close)
    return node


def _add_brain(
    plan: Plan,
    node: Node,
    presence: Presence,
    robot: HostedRobotPart | None,
    watch: AlertPart | None,
    recording: RecordingPart,
) -> None:
    """Add the behaviour, and the parts that serve it."""
    project, bus, narrator, story, directory = plan.project, plan.bus, plan.narrator, plan.story, plan.directory
    records, options = directory.records, plan.options
    node.parts.append(ModuleTroublesPart(project, bus, narrator.line))
    body = RemoteBody(staged(project, story), bus, plan.clock, presence)

    def adopt(bundle: Project) -> None:
        body.robot.use(bundle)
        node.use(bundle)

    behavior = body.behavior(project, bus, story, options.speed, adopt)
    reloader = directory.reloader(behavior, narrator, mode=options.reload)

    def stopped() -> StoppedBy | None:
        return robot.server.hold.stopped if robot else stopped_there(presence)

    def recover() -> Resumption | FreshStart:
        found = directory.begin_run(behavior, options.url, reloader, fresh=options.fresh)
        operator.recover(records.decisions(), resumed=isinstance(found, Resumption))
        return watch.recovered(found) if watch else found

    brain = RemoteBrainPart(behavior, body, narrator, presence, directory.home, options.language, stopped, recover)
    journal = record_inputs(behavior, records, story=story, rehearsed=story is not None)
    node.closing.append(records.close_inputs)
    if watch and plan.alerts:
        behavior.loop.observers.append(watch)
        node.parts.append(RefusalPart(reloader, plan.alerts))
    operator = OperatorPart(
        behavior,
        narrator,
        journal,
        stopped=stopped,
        realtime=lambda: node.pace.realtime,
        reloaded=lambda: reloader.last_reload,
        record=records.write,
        keep=records.keep_decisions,
        marking=recording.marking,
        needs=brain.needs,
    )
    if directory.home and story is None:
        operator.model.keep(directory.home.folder)
    tell = partial(narrator.line, "fleet")
    agent = fleet_part(directory.root, bus, behavior, reloader, directory.home, tell, brain.needs)
    node.parts += [
        ReloadPart(reloader, brain.needs),
        *([agent] if agent and story is None else []),
        operator,
        ForgettingPart(project, bus, behavior.forget, records.forget, needs=brain.needs),
        brain,
        RecordsPart(records, behavior, brain.needs),
    ]
