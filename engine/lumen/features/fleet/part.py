"""The part that connects a robot's fleet agent to the bus, the reload and the robot's home."""

import os
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.errors import BusError
from lumen.features.fleet.agent import FleetAgent
from lumen.features.fleet.installing import all_have, bundle_folder, install, written
from lumen.features.fleet.memory import keep, remember
from lumen.features.fleet.reading import read_fleet
from lumen.features.fleet.settings import Fleet, FleetMeasure
from lumen.language.diagnostics import has_errors
from lumen.language.events import Event
from lumen.language.fleet_keys import bundle_key, desired_key, incident_key, numbers_key, presence_key
from lumen.ports import Message
from lumen.project.files import fingerprint, read_files
from lumen.project.home import Home
from lumen.run.live_behavior import LiveBehavior
from lumen.run.loop import Observer
from lumen.run.making.serving import directory_of
from lumen.run.parts.part import Part
from lumen.run.reload.reloader import Reloader
from lumen.run.services import Services
from lumen.run.snapshot_store import SnapshotStore
from lumen.statechart import Step


class MeasureCounter(Observer):
    """Counts the fleet's measures from the steps of a behaviour."""

    def __init__(self, measures: Mapping[str, FleetMeasure]) -> None:
        self._measures, self._counts = measures, dict.fromkeys(measures, 0)

    def stepped(self, step: Step) -> None:
        """Count the events and entered states of a step."""
        events = [event.name for event in (step.event, *step.raised) if event]
        for name, measure in self._measures.items():
            if measure.event:
                self._counts[name] += sum(fnmatchcase(event, measure.event) for event in events)
            if measure.enters:
                self._counts[name] += sum(fnmatchcase(state, measure.enters) for state in step.entered)

    def take(self) -> dict[str, int]:
        """Return the count of each measure since the last call, and reset the counts."""
        found, self._counts = self._counts, dict.fromkeys(self._measures, 0)
        return found


HOUSE_VARIABLE = "LUMEN_HOUSE"
PERIOD = 10.0
"""The maximum time between two messages about the robot's presence [s]."""
NUMBERS_PERIOD = 3600.0
"""The time between two messages with counts for long-term statistics [s].

A bundle's counts are also sent as soon as another bundle runs.
"""
MAX_WAITING = 50


class ReloadTaker:
    """Applies files through a running exhibition's reload; `installed` is called when the project folder has them."""

    def __init__(
        self, root: Path, reloader: Reloader, behavior: LiveBehavior, home: Home, installed: Callable[[], None]
    ) -> None:
        self._root, self._reloader, self._behavior, self._installed = root, reloader, behavior, installed
        self.unwritten = ""
        self._store = SnapshotStore(home)

    @property
    def running(self) -> str:
        """The hash of the running files."""
        return self._behavior.loop.project.hash

    @property
    def on_probation(self) -> bool:
        """Whether the running files are still on probation."""
        return self._reloader.on_probation

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        """Return the files with that hash if they are stored or in the project's folder, else None."""
        kept = self._store.files(hash)
        if kept is None and fingerprint(there := read_files(self._root)) == hash:
            return there
        return kept

    def offer(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Offer files to the reload; `answer` receives each verdict."""
        self._reloader.offer(files, answer)

    def attempt(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Judge files without applying them; `answer` receives the verdict."""
        self._reloader.offer(files, answer, dry=True)

    def install(self, files: Mapping[str, bytes]) -> None:
        """Write files into the project's folder, but only if all robots that share the folder run these files."""
        project, hash = self._behavior.loop.project, fingerprint(files)
        if project.told_apart and not all_have(self._root, hash, project.robots):
            return

        def change() -> Mapping[str, bytes]:
            self.unwritten = install(self._root, files)
            if not self.unwritten:
                self._installed()
            return read_files(self._root)

        self._reloader.write(change)


class FleetPart(Part):
    """The part that runs this robot's agent, only while its process has the roles `needs`."""

    patient = True

    def __init__(
        self,
        fleet: Fleet,
        house: str,
        bus: ValidatedBus,
        behavior: LiveBehavior,
        reloader: Reloader,
        home: Home,
        root: Path,
        tell: Callable[[str], None],
        needs: Sequence[str] = (),
    ) -> None:
        self.needs, self._house, self._robot = needs, house, behavior.project.robot
        self._bus, self._home = bus.unchecked, home
        self.counter = MeasureCounter(fleet.measures)
        behavior.loop.observers.append(self.counter)
        memory = remember(home, self._robot)
        taker = ReloadTaker(root, reloader, behavior, home, lambda: written(home, self._robot, memory))
        self.agent = FleetAgent(
            house, self._robot, fleet.key, taker, memory, bundle_folder(root),
            save=lambda memory: keep(home, self._robot, memory), tell=tell, incident=self._incident,
        )  # fmt: skip
        self._received: deque[Message] = deque(maxlen=MAX_WAITING)
        self._told, self._as = time.monotonic(), ""
        self._counting, self._numbered = ("", 0.0), time.monotonic()
        self._undo = [
            self._bus.subscribe(key, self._received.append) for key in (desired_key(house), bundle_key(house))
        ]

    def begin(self, now: float) -> None:
        """Publish the robot's presence."""
        self._tell_presence()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Process received orders and bundles, advance the agent, and publish a changed or due presence."""
        while self._received:
            message = self._received.popleft()
            hear = self.agent.order if message.key == desired_key(self._house) else self.agent.bundle
            hear(message.body)
        self.agent.tick()
        at = f"{self.agent.state} {self.agent.running} {self.agent.wants} {self.agent.memory.order}"
        if at != self._as or time.monotonic() - self._told >= PERIOD:
            self._as = at
            self._tell_presence()

    def close(self) -> None:
        """End the subscriptions."""
        for undo in self._undo:
            undo()

    def _tell_presence(self) -> None:
        now = time.monotonic()
        said = self.agent.presence(now - self._told, self.counter.take())
        self._told = now
        self._tell_numbers(now)
        with suppress(BusError):
            self._bus.publish(presence_key(self._house, self._robot), said.to_json(), ttl=60.0)

    def _tell_numbers(self, now: float) -> None:
        """Publish the previous bundle's counts when another bundle runs, and the present bundle's counts each hour."""
        memory = self.agent.memory
        before, self._counting = self._counting, (self.agent.running, memory.since)
        ended = bool(before[0]) and before != self._counting
        if not ended and now - self._numbered < NUMBERS_PERIOD:
            return
        bundle, since = before if ended else self._counting
        self._numbered = now
        body = {"bundle": bundle, "since": since, "counts": dict(memory.past if ended else memory.now)}
        with suppress(BusError):
            self._bus.publish(numbers_key(self._house, self._robot), body)

    def _incident(self, kind: str, text: str) -> None:
        body = {"kind": kind, "text": text, "bundle": self.agent.running}
        with suppress(BusError):
            self._bus.publish(incident_key(self._house, self._robot), body)


def make(services: Services) -> FleetPart | None:
    """Make the part for a robot that belongs to a fleet.

    Return None for any other robot, in a story, without a project folder, or with `--reload off`.
    """
    directory, project = directory_of(services), services.plan.project
    if directory is None or directory.home is None or services.plan.story:
        return None
    if (found := fleet_of(directory.root, project.house, project.robot)) is None:
        return None
    reloader, tell = services[Reloader], services.tell("fleet")
    if reloader.mode == "off":
        tell("bundles of the fleet are ignored because of --reload off")
        return None
    bus, behavior, home = services.bus, services.behavior, directory.home
    return FleetPart(*found, bus, behavior, reloader, home, directory.root, tell, services.needs)


def fleet_of(root: Path, house: str, robot: str) -> tuple[Fleet, str] | None:
    """Return a robot's fleet and house; None if fleet.yaml has errors or no key, or if no single house is found.

    The house is `house`, if the fleet has it, else the value of HOUSE_VARIABLE, else the only house with the robot. It
    must list the robot.
    """
    read, found = read_fleet(root)
    fleet = read.built if read else None
    if fleet is None or not fleet.key or has_errors(found):
        return None
    said = house if house in fleet.houses else os.environ.get(HOUSE_VARIABLE, "")
    named = [name for name, row in fleet.houses.items() if robot in row.robots and said in ("", name)]
    return (fleet, named[0]) if len(named) == 1 else None
