"""Makers of the parts that serve the behaviour: its journal, forgetting, reload, and operators."""

from typing import Any

from lumen.journal.journal_writer import JournalWriter
from lumen.motion.bounds import analyse
from lumen.robot.person_hold import StoppedBy
from lumen.run.forgetting.added import FeatureForgetter
from lumen.run.parts.forgetting import ForgettingPart
from lumen.run.parts.hosted_robot import HostedRobotPart, stopped_there
from lumen.run.parts.operating import OperatorPart, RunState
from lumen.run.parts.own_module import statuses as own_module_statuses
from lumen.run.parts.robot import RobotPart
from lumen.run.recovery.journaling import record_inputs
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader, ReloadOptions
from lumen.run.reload.saved_files import RecordsPart, ReloadPart
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.services import Services
from lumen.run.status import SKILL_STATES, LastReload


def journal(services: Services) -> None:
    """Provide the records of the run, and the journal of the behaviour's inputs."""
    plan, directory = services.plan, directory_of(services)
    records = directory.records if directory else RunRecords(None)
    rehearsed = plan.story is not None or directory is None
    services.provide(records, record_inputs(services.behavior, records, story=plan.story, rehearsed=rehearsed))
    if directory and (plan.roles or not plan.story):
        analyse(plan.project.motions.values(), plan.project.body)


def forgetting(services: Services) -> ForgettingPart | None:
    """Make the part that forgets a visitor; None if this process keeps no data about visitors."""
    project, bus, added = services.plan.project, services.bus, FeatureForgetter(services.get, services.failed)
    if services.plan.brain:
        forget = services.behavior.forget, services[RunRecords].forget, added.forget
        return ForgettingPart(project, bus, *forget, needs=services.needs)
    robot = services.get(HostedRobotPart)
    return ForgettingPart(project, bus, robot.forget, added.forget) if robot else None


def reload(services: Services) -> ReloadPart:
    """Make the part that reloads saved files."""
    mode, directory = services.plan.options["reload"], directory_of(services)
    take = directory.reloader if directory else Reloader
    reloader = take(services.behavior, services.narrator, ReloadOptions(mode), wake=services.nap.end)
    services.provide(reloader)
    return ReloadPart(reloader, services.needs)


def operator(services: Services) -> OperatorPart:
    """Make the part that answers operators."""
    directory = directory_of(services)
    reloader = services.get(Reloader)

    def stopped() -> StoppedBy | None:
        robot = services.get(RobotPart)
        if robot:
            return robot.server.hold.stopped
        return stopped_there(services.presence) if services.presence else None

    def marking() -> str:
        return next(filter(None, (part.marking() for part in services.node.parts)), "")

    def skills() -> dict[str, Any]:
        told = (part.said.get(SKILL_STATES) or {} for part in services.node.parts)
        return {name: state for each in told for name, state in each.items()}

    def reloaded() -> LastReload | None:
        return reloader.last_reload if reloader else None

    return OperatorPart(
        services.behavior,
        services.narrator,
        services[JournalWriter],
        services[RunRecords],
        RunState(
            stopped,
            lambda: services.node.pace.realtime,
            reloaded,
            lambda: own_module_statuses(services.node.parts),
            skills,
        ),
        marking=marking,
        kept=directory.home.folder if directory and directory.home and services.lasts else None,
        needs=services.needs,
    )


def records(services: Services) -> RecordsPart:
    """Make the part that saves the behaviour's snapshot and completes the journal.

    A story in one process saves nothing; in a brain's own process the snapshot lets it continue after a crash.
    """
    plan = services.plan
    lasts = directory_of(services) is not None and (plan.story is None or bool(plan.roles))
    return RecordsPart(services[RunRecords], services.behavior, services.needs, lasts=lasts)


def recovered(services: Services) -> Resumption | FreshStart:
    """Resume the previous run with its operator's decisions, or begin a new one; notify all parts of the result."""
    directory, options = directory_of(services), services.plan.options
    if directory is None:
        return FreshStart()
    fresh = options.get("fresh", True) or (services.plan.story is not None and not services.plan.roles)
    found = directory.begin_run(services.behavior, services.plan.url, services.get(Reloader), fresh=fresh)
    services[OperatorPart].recover(directory.records.decisions(), resumed=isinstance(found, Resumption))
    for part in services.node.parts:
        part.recovered(found)
    return found


def directory_of(services: Services) -> RunDirectory | None:
    """Return the directory of the run; None for a run that saves nothing."""
    directory: RunDirectory | None = services.plan.options.get("directory")
    return directory
