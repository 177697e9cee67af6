"""A centre that runs: its folder, its bus, and a look a second until somebody ends it."""

import threading
import time
import uuid
from collections.abc import Callable
from pathlib import Path

from lumen.app.fleet.centre import Centre
from lumen.app.fleet.centre_desk import CentreDesk
from lumen.app.fleet.centre_journal import CentreJournal
from lumen.app.fleet.kept_bundles import BundleFolder
from lumen.app.fleet.signing import Signer
from lumen.errors import UsageError
from lumen.interpreters.fleet.state import CentreState
from lumen.language.diagnostics import has_errors
from lumen.language.fleet import Fleet
from lumen.loading.fleet import read_fleet
from lumen.ports import Bus
from lumen.runtime.home import Home, home_of
from lumen.upkeep.private_folder import private_folder

LOOK_PERIOD = 1.0
"""How often a centre looks at its fleet [s]."""
FOLDER = "centre"


def fleet_in(root: Path) -> Fleet:
    """The fleet of that folder. Raises UsageError where there is none that can be used."""
    read, found = read_fleet(root)
    if read is None and not found:
        raise UsageError(f"there is no fleet.yaml in {root.absolute()}: docs/fleet.md says what stands in it")
    if read is None or read.built is None or has_errors([*found, *read.report.diagnostics]):
        first = next(iter([*found, *(read.report.diagnostics if read else ())]), "")
        raise UsageError(f"fleet.yaml has errors: {first}")
    return read.built


class ServedCentre:
    """The centre of the fleet in a folder, on a bus that it closes at its end.

    Raises UsageError where another process is it already, or the key is not the one of fleet.yaml.
    """

    def __init__(self, root: Path, signer: Signer, bus: Bus, tell: Callable[[str], None]) -> None:
        self._bus = bus
        fleet = fleet_in(root)
        if fleet.key != signer.public:
            raise UsageError(f"this key is not the one that robots trust: fleet.yaml says `key: {fleet.key}`")
        private_folder(home := home_of(root))
        self._home = Home(home / FOLDER)
        if not self._home.hold():
            raise UsageError(f"another process is the centre of {root.absolute()} already")
        journal = CentreJournal(self._home.folder)
        state = journal.last() or CentreState(uuid.uuid4().hex)
        self.centre = Centre(fleet, state, journal, BundleFolder(self._home.folder), signer, bus, tell=tell)
        self._desk = CentreDesk(self.centre, bus)
        self._ending = threading.Event()

    def tick(self) -> None:
        """Look once."""
        self._desk.tick(time.time())
        self.centre.tick()

    def run(self) -> None:
        """Look until `end`."""
        while not self._ending.is_set():
            self.tick()
            self._ending.wait(LOOK_PERIOD)

    def end(self) -> None:
        """Let `run` return; safe in a signal handler."""
        self._ending.set()

    def close(self) -> None:
        self._desk.close()
        self.centre.close()
        self._bus.close()
        self._home.release()
