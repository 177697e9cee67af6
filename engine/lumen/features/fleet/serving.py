"""A running centre: its folder, its bus, and a tick each second."""

import queue
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from lumen.bus.brokers import Stream, has_streams, stream_of
from lumen.errors import UsageError
from lumen.features.fleet.centre import Centre
from lumen.features.fleet.centre_desk import CentreDesk
from lumen.features.fleet.centre_journal import CentreJournal
from lumen.features.fleet.fleet_log import FleetLog
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.reading import read_fleet
from lumen.features.fleet.rollouts.state import CentreState
from lumen.features.fleet.settings import Fleet
from lumen.features.fleet.signing import Signer
from lumen.language.diagnostics import has_errors
from lumen.language.fleet_keys import STREAM
from lumen.ports import Bus
from lumen.project.home import Home, home_of
from lumen.upkeep.own_folders import private_folder

LOOK_PERIOD = 1.0
"""The time between two ticks of a centre [s]."""
FOLDER = "centre"


def fleet_in(root: Path) -> Fleet:
    """Return the fleet in a folder. Raises UsageError if fleet.yaml is missing or has errors."""
    read, found = read_fleet(root)
    if read is None and not found:
        raise UsageError(f"there is no fleet.yaml in {root.absolute()}: write one, as docs/fleet.md shows")
    if read is None or read.built is None or has_errors([*found, *read.report.diagnostics]):
        first = next(iter([*found, *(read.report.diagnostics if read else ())]), "")
        raise UsageError(f"fleet.yaml has errors: {first}")
    return read.built


class ServedCentre:
    """The centre of the fleet in a folder, on a bus that `close` closes; it reads the stream of the broker at `url`.

    Raises UsageError if fleet.yaml is unusable, its key does not match `signer`, or another process is the centre.
    """

    def __init__(self, root: Path, signer: Signer, bus: Bus, tell: Callable[[str], None], url: str = "") -> None:
        self._bus = bus
        fleet = fleet_in(root)
        if fleet.key != signer.public:
            raise UsageError(
                f"the private key does not match `key: {fleet.key}` in fleet.yaml, which robots trust: pass --key FILE"
            )
        private_folder(home := home_of(root))
        self._home = Home(home / FOLDER)
        if not self._home.hold():
            raise UsageError(f"another process is already the centre of {root.absolute()}")
        journal = CentreJournal(self._home.folder)
        state = journal.last() or CentreState(uuid.uuid4().hex)
        log = FleetLog(self._home)
        self._stream = self._opened(url, log.next, tell)
        kept = BundleFolder(self._home.folder)
        self.centre = Centre(fleet, state, journal, kept, signer, bus, log, self._stream, tell=tell)
        self._desk = CentreDesk(self.centre, bus)
        self._ending: queue.SimpleQueue[None] = queue.SimpleQueue()  # unlike an Event, safe in a signal handler

    def tick(self) -> None:
        """Answer the received requests, then advance the centre."""
        self._desk.tick(time.time())
        self.centre.tick()

    def run(self) -> None:
        """Tick until `end` is called."""
        while self._ending.empty():
            self.tick()
            with suppress(queue.Empty):
                self._ending.put(self._ending.get(timeout=LOOK_PERIOD))

    def end(self) -> None:
        """Make `run` return; safe in a signal handler."""
        self._ending.put(None)

    def _opened(self, url: str, first: int, tell: Callable[[str], None]) -> Stream | None:
        if not has_streams(url):
            return None
        if (stream := stream_of(url, STREAM, first)) is None:
            tell(
                f"the broker has no stream {STREAM}: incidents are lost while no centre is running;"
                " docs/fleet-brokers.md shows how to create it"
            )
        return stream

    def close(self) -> None:
        """Close the stream, the centre and the bus, and release the folder."""
        self._desk.close()
        if self._stream:
            self._stream.close()
        self.centre.close()
        self._bus.close()
        self._home.release()
