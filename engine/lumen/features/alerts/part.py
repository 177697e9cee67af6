"""The part that sends alerts about an exhibition's trouble to people who are not at the exhibition."""

import shutil
import threading
import time
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from lumen.bus.validated import ValidatedBus
from lumen.features.alerts.alert import Origin
from lumen.features.alerts.desk import AlertDesk
from lumen.features.alerts.settings import Alerts
from lumen.language.commands import Command, Posture, Start, Wake
from lumen.language.events import Event
from lumen.language.modules import own_modules
from lumen.language.projects import Project
from lumen.ports import BlockableBus, UsesBroker
from lumen.project.home import home_of
from lumen.run.loop import Observer
from lumen.run.making.serving import directory_of
from lumen.run.parts.brain import ENGINE, RUN_BEFORE
from lumen.run.parts.hosted_robot import HostedRobotPart
from lumen.run.parts.part import Part
from lumen.run.presence import BRAIN, ROBOT_PART, Presence, unique_parts
from lumen.run.reload.records import RunRecords
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.run_start import RunFailure
from lumen.run.services import Services
from lumen.statechart import Step
from lumen.upkeep.threads import WatchedThread

TIME_TO_RISE = 60.0
"""The time limit for getting up after a fall [s]; a robot that gets up by itself needs about 20 s."""


class FallWatch:
    """Detects that the robot does not get up after a fall; `tick` reports each such fall only once."""

    def __init__(self) -> None:
        self._fallen: float | None = None
        self._rising: set[str] = set()
        self._failed = False

    def performing(self, command: Command) -> None:
        """Record a command that makes the robot get up."""
        match command:
            case Start(id, Posture() | Wake()):
                self._rising.add(id)

    def answered(self, event: Event, now: float) -> None:
        """Record a fall, or the result of an attempt to get up."""
        kind, _, id = event.name.partition(".command.")
        if event.name == "fallen" and self._fallen is None:
            self._fallen, self._failed, self._rising = now, False, set()
        elif id in self._rising:
            self._rising.discard(id)
            self._failed = self._failed or kind == "error"
            if kind == "done":
                self._fallen, self._failed = None, False

    def tick(self, now: float) -> str:
        """Return the trouble after a fall; empty if the robot stands, may still get up, or the fall was reported."""
        if self._fallen is None:
            return ""
        why = "it fell and can't get up" if self._failed else "it fell and has not got up"
        if not self._failed and now - self._fallen < TIME_TO_RISE:
            return ""
        self._fallen, self._failed = None, False
        return why


LEAST_ROOM = 100_000_000
"""The minimum free space of a disk [bytes], which the database, the journal and a bundle can fill in a bad month."""
LOOK_INTERVAL = 60.0
"""The time between two checks of the disk [s], on a separate thread because a network disk can be slow."""


class DiskWatch:
    """Checks the free space of the disk with `folder`; `trouble` describes a shortage or an error, else it is empty."""

    def __init__(self, folder: Path) -> None:
        self.trouble = ""
        self._folder = folder
        self._ending = threading.Event()
        self._thread = WatchedThread("lumen-disk", self._run)
        self._thread.start()

    def close(self) -> None:
        """End the thread, without waiting for a disk that does not answer."""
        self._ending.set()
        self._thread.join(0.1)

    def _run(self) -> None:
        while True:
            self.trouble = room(self._folder)
            if self._ending.wait(LOOK_INTERVAL):
                return


def room(folder: Path) -> str:
    """Return the problem of the disk with a folder, or with its nearest existing parent; empty for none."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    try:
        free = shutil.disk_usage(folder).free
    except OSError as error:
        return f"the free space of the disk can't be read: {error.strerror}"
    return f"the disk is nearly full: {free / 1e6:.0f} MB are left" if free < LEAST_ROOM else ""


BROKER_PATIENCE = 5.0
"""The time without a broker after which its absence is reported [s]; a restart takes less time."""
BRAIN_PATIENCE = 5.0
"""The time without the robot's brain after which its absence is reported [s]."""


class AlertPart(Part, Observer):
    """Reports trouble with the robot, the brain, the broker and the disk to an alert desk, which `close` closes.

    If the brain is in this process, this part observes the brain's loop. A process with only the robot reports the
    robot's events only while no brain is connected. `own` has the names of the project's own modules. `kept` returns
    why the run's records can't be written, empty if they can; `stopped` returns whether a person stopped the robot.
    """

    patient = True
    watches = True

    def __init__(
        self,
        desk: AlertDesk,
        bus: ValidatedBus,
        folder: Path,
        parts: Sequence[str],
        presence: Presence | None = None,
        kept: Callable[[], str] = lambda: "",
        stopped: Callable[[], bool] = lambda: False,
        own: Collection[str] = (),
    ) -> None:
        self._desk, self._parts, self._presence = desk, parts, presence
        self._broker, self._blockable = bus.ability(UsesBroker), bus.ability(BlockableBus)
        self._kept, self._clock, self._person_stopped = kept, time.monotonic, stopped
        self._own = own
        self._falls, self._disk = FallWatch(), DiskWatch(folder)
        self._now = 0.0
        self._away: float | None = None
        self._blocked = ""
        self._brain: float | None = None
        self._missed = False
        self._troubles: dict[str, str] = {}
        self._stopped: bool | None = None

    def recovered(self, found: Resumption | FreshStart) -> None:
        """Report an unexpected end of the earlier run, unless it is already reported."""
        if isinstance(found, Resumption):
            if not found.told:
                self._desk("crashed", f"it ended unexpectedly, and continues after {found.away:.0f} s")
        elif found.crashed:
            self._desk("crashed", "it ended unexpectedly, and starts from the beginning")

    def stepped(self, step: Step) -> None:
        """Report a stop by a person, and the loss or return of the project's own modules."""
        if step.event and step.event.name == "stop" and _by_person(step.event):
            self._desk("stopped", "a person stopped it")
        if step.event and (found := told_of_own(step.event, self._own)):
            self._desk(*found)

    def performing(self, command: Command, now: float) -> None:
        """Record a command that makes the robot get up."""
        self._falls.performing(command)

    def answered(self, event: Event) -> None:
        """Process an answer or event from the robot, and report it if it needs an alert."""
        self._falls.answered(event, self._now)
        self._notice(event)

    def noticed(self, event: Event) -> None:
        """Report the robot's events if no brain is connected."""
        if self._presence and self._presence.find(BRAIN) is None:
            self._notice(event)
            if event.name == "fallen":
                self._desk("fallen", "it fell, and no brain is connected to get it up")

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Report falls, stops, lost or returned parts, and trouble with the broker, the brain and the disk."""
        self._now = now
        if why := self._falls.tick(now):
            self._desk("fallen", why)
        for event in changes if BRAIN in self._parts else ():
            if not self._left(event.name.removesuffix(".lost")):
                self._notice(event)
        self._look_for_broker()
        self._look_for_brain()
        self._look_for_stop()
        self._look_at_disk("room", self._disk.trouble)
        self._look_at_disk("records", self._kept())

    def use(self, project: Project) -> None:
        """Use another project's recipients and own modules."""
        self._desk.use(project.section(Alerts))
        self._own = own_modules(project.modules)

    def helpless(self, reason: str) -> None:
        """Report that the robot rests because a part that is needed to stop it has failed."""
        self._desk("crashed", "a part of Lumen failed. The robot rests, because no one could have stopped it")

    def part_stopped(self, part: str) -> None:
        """Report that a part failed and is not running."""
        self._desk("lost", f"{part} failed and is not running", part)

    def close(self) -> None:
        """End the disk checks and deliver waiting alerts."""
        self._disk.close()
        self._desk.close()

    def _notice(self, event: Event) -> None:
        if found := told_of(event):
            self._desk(*found)

    def _look_for_broker(self) -> None:
        """Report trouble with the broker, but only in the processes with the robot or the brain."""
        if not {ROBOT_PART, BRAIN} & set(self._parts):
            return
        blocked, before = self._blockable.blocked if self._blockable else "", self._blocked
        self._blocked = blocked
        if blocked and not before:
            self._desk("broker", f"the message broker is short of {blocked} and accepts no messages", "blocked")
        if not (self._broker and self._broker.away):
            self._away = None
        elif self._away is None:
            self._away = self._clock()
        elif self._clock() - self._away > BROKER_PATIENCE:
            self._desk("broker", "the message broker can't be reached")
            self._away = float("inf")

    def _look_for_brain(self) -> None:
        """In a process with only the robot, report the brain's loss, unless it ended properly, and its return."""
        if self._presence is None or BRAIN in self._parts or ROBOT_PART not in self._parts:
            return
        if self._presence.find(BRAIN):
            if self._missed:
                self._desk("lost", "the brain is back", "brain.back")
            self._brain, self._missed = self._clock(), False
        elif self._left(BRAIN):
            self._brain = None
        elif self._brain is not None and self._clock() - self._brain > BRAIN_PATIENCE and not self._missed:
            self._missed = True
            self._desk("lost", "the brain no longer responds, and the robot rests", BRAIN)

    def _look_for_stop(self) -> None:
        """Report that a person stopped the robot, if no brain is connected to report it."""
        before, self._stopped = self._stopped, self._person_stopped()
        if self._stopped and before is False and self._presence and self._presence.find(BRAIN) is None:
            self._desk("stopped", "a person stopped it")

    def _left(self, part: str) -> bool:
        """Return whether a part has ended properly; False if unknown."""
        return self._presence is not None and self._presence.left(part)

    def _look_at_disk(self, about: str, trouble: str) -> None:
        """Report the disk problem `trouble` when it begins; `about` distinguishes problems."""
        if trouble and not self._troubles.get(about):
            self._desk("disk", trouble, about)
        self._troubles[about] = trouble


def make(services: Services) -> AlertPart:
    """Make the part that sends alerts about trouble, and provide its desk."""
    plan, directory, root = services.plan, directory_of(services), Path(services.project.root)
    parts = plan.roles or (ROBOT_PART, BRAIN)
    origin = Origin(plan.project.name, plan.project.robot, parts)
    desk = AlertDesk(plan.project.section(Alerts), origin, root, services.tell("alerts"))
    services.provide(desk)
    records = directory.records if directory else RunRecords(None)

    def kept() -> str:
        return next(filter(None, (records.trouble, *(part.trouble for part in services.node.parts))), "")

    def stopped() -> bool:
        robot = services.get(HostedRobotPart)
        return not plan.brain and robot is not None and robot.stopped()

    folder = home_of(root, plan.project.one_of_several)
    own = own_modules(plan.project.modules)
    return AlertPart(desk, services.bus, folder, parts, services.presence, kept, stopped=stopped, own=own)


def tell_of_failure(failure: RunFailure) -> Callable[[], None]:
    """Send an alert that a run failed, and return the function that closes the alert desk.

    The recipients come from the present files, else from the last good files.
    """
    alerts = failure.settings.section(Alerts) if failure.settings else Alerts()
    if not alerts.to and (good := failure.last_good()):
        alerts = good.section(Alerts)
    origin = Origin(failure.name, failure.robot, failure.parts)
    desk = AlertDesk(alerts, origin, failure.root, failure.tell)
    desk(failure.kind, failure.text)
    return desk.close


def told_of(event: Event) -> tuple[str, str, str] | None:
    """Return the kind, text and `about` of the alert for an event; None if the event needs no alert.

    Any program on the bus can send an event, so only numbers from its data are quoted.
    """
    part, _, what = event.name.partition(".")
    match part, what:
        case _, "lost" if part in unique_parts():
            return "lost", f"the {part} no longer responds", part
        case _, "back" if part in unique_parts():
            return "lost", f"the {part} is back after {_number(event, 'seconds')} s", event.name
        case "battery", "low":
            return "battery", f"its battery is at {_number(event, 'percentage')} %", ""
        case "motors", "hot":
            return "hot", f"a motor is at {_number(event, 'temperature')} °C", ""
    return None


def told_of_own(event: Event, modules: Collection[str]) -> tuple[str, str, str] | None:
    """Return the alert for the loss or return of a module in `modules`, as `told_of` does; None for other events."""
    module, _, what = event.name.partition(".")
    if module not in modules:
        return None
    if what == "lost":
        return "lost", f"the module {module} no longer responds", module
    return ("lost", f"the module {module} is back", event.name) if what == "found" else None


def _number(event: Event, key: str) -> str:
    value = event.data.get(key) if isinstance(event.data, dict) else None
    return f"{value:.0f}" if isinstance(value, int | float) and abs(value) < 1e6 else "?"


def _by_person(stop: Event) -> bool:
    """Return whether a person stopped the robot; other causes have separate alerts."""
    by = stop.data.get("by") if isinstance(stop.data, dict) else None
    return by not in (ENGINE, RUN_BEFORE)
