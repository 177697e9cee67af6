"""The exhibition's console in a separate process, which is restarted if it ends; the exhibition is not affected."""

import os
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.bus.addresses import within_process
from lumen.language.events import Event
from lumen.run.making.serving import directory_of
from lumen.run.parts.part import Part
from lumen.run.services import Services
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

FIRST_PAUSE, LONGEST_PAUSE = 1.0, 60.0
"""The pause before the first restart, doubled for each further one, and the longest pause [s]."""
LOOK_PERIOD = 0.5
STABLE = 30.0
"""A process that ran longer than this resets the pause [s]."""
END_TIMEOUT = 5.0


class ConsolePart(Part):
    """Runs `lumen console` for the project in `root` on the bus at `url`; `tell` receives the lines that it prints."""

    patient = True

    def __init__(self, root: Path, url: str, tell: Callable[[str], None]) -> None:
        self._root, self._url, self._tell = root, url, tell
        self._process: subprocess.Popen[str] | None = None
        self._lines: deque[str] = deque(maxlen=20)
        self._said = ""
        self._backoff = Backoff(FIRST_PAUSE, LONGEST_PAUSE)
        self._next, self._began, self._looked = 0.0, 0.0, 0.0

    @property
    def pid(self) -> int | None:
        """The id of the process, None while it does not run."""
        return self._process.pid if self._process else None

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        while self._lines:
            if (line := self._lines.popleft()) != self._said:
                self._said = line
                self._tell(line)
        here = time.monotonic()
        if here - self._looked < LOOK_PERIOD:
            return
        self._looked = here
        if self._process is not None and (code := self._process.poll()) is not None:
            self._process = None
            if here - self._began > STABLE:
                self._backoff.reset()
            pause = self._backoff.next()
            self._next = here + pause
            self._tell(f"the console has ended (exit code {code}); it restarts in {pause:g} s")
        if self._process is None and here >= self._next:
            self._begin(here)

    def close(self) -> None:
        if (process := self._process) is None:
            return
        self._process = None
        with suppress(OSError), process:  # which closes its pipes
            process.terminate()
            try:
                process.wait(END_TIMEOUT)
            except subprocess.TimeoutExpired:
                process.kill()

    def _begin(self, now: float) -> None:
        environment = dict(os.environ)
        if not within_process(self._url):
            environment["LUMEN_BUS"] = self._url  # it may contain a password, and anyone can read arguments
        else:
            environment.pop("LUMEN_BUS", None)
        command = [sys.executable, "-m", "lumen", "console", str(self._root), "--beside"]
        try:
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                errors="replace", env=environment, start_new_session=True,
            )  # fmt: skip
        except OSError as error:
            self._next = now + self._backoff.next()
            self._tell(f"the console can't start: {error.strerror or error}")
            return
        self._began = now
        process = self._process
        WatchedThread("lumen-console-lines", lambda: self._read(process)).start()

    def _read(self, process: "subprocess.Popen[str]") -> None:
        with suppress(OSError, ValueError):
            for line in process.stdout or ():
                self._lines.append(line.strip()[:300])


def make(services: Services) -> ConsolePart:
    """Return the part that serves the console's pages in a separate process."""
    directory = directory_of(services)
    root = directory.root if directory else Path(services.project.root)
    return ConsolePart(root, services.plan.url, services.tell("console"))
