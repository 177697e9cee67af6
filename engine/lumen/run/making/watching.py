"""Recording of the bus, and alerts."""

from pathlib import Path

from lumen.features.alerts.desk import AlertDesk
from lumen.features.alerts.part import AlertPart
from lumen.features.alerts.reloads import RefusalPart
from lumen.features.mcap.part import RecordingPart
from lumen.project.home import home_of
from lumen.run.making.serving import directory_of
from lumen.run.parts.hosted_robot import HostedRobotPart
from lumen.run.presence import BRAIN, ROBOT_PART
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader
from lumen.run.services import Services


def recording(services: Services) -> RecordingPart:
    """Make the recorder of the bus, which also recovers what the run before left half written."""
    plan = services.plan
    file, patient = plan.options.get("record"), plan.story is not None and not plan.roles
    tell = services.tell("recording")
    return RecordingPart(plan.project, services.bus, tell, file, ring=services.lasts, patient=patient)


def alerts(services: Services) -> AlertPart:
    """Make the part that sends alerts about trouble."""
    plan, desk = services.plan, services.plan.options["alerts"]
    directory, recording = directory_of(services), services.get(RecordingPart)
    records = directory.records if directory else RunRecords(None)

    def kept() -> str:
        return records.trouble or (recording.trouble if recording else "")

    def stopped() -> bool:
        robot = services.get(HostedRobotPart)
        return not plan.brain and robot is not None and robot.stopped()

    folder = home_of(Path(plan.project.root), plan.project.one_of_several)
    parts = plan.roles or (ROBOT_PART, BRAIN)
    return AlertPart(desk, services.bus, folder, parts, services.presence, kept, stopped=stopped)


def refusals(services: Services) -> RefusalPart:
    """Make the part that sends alerts about refused files."""
    desk: AlertDesk = services.plan.options["alerts"]
    return RefusalPart(services[Reloader], desk)
