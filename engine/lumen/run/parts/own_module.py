"""A module of the project's own: a program that the exhibition starts, or that runs elsewhere on the bus."""

import os
import platform
import sys
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from lumen.errors import BusError
from lumen.language.events import Event
from lumen.language.iso_time import iso_time
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.run.parts.part import Part
from lumen.run.presence import HERE, LEAVES, PRESENCE_PERIOD, PRESENCE_ROUTE, PRESENCE_TTL
from lumen.upkeep.supervised_process import END_TIMEOUT, SupervisedProcess

DEFAULT_HEALTH = 5.0
"""The default of `health`: the longest time between two signs of life of a program [s]."""
START_TIMEOUT = 30.0
"""The longest time until the first sign of life of a program started here [s]; its `health` if that is longer."""
STEADY = 2.0
"""The time that a program without signs of life must run after a loss to count as found [s]."""
MAX_PENDING_PRESENCES = 1_000
"""The number of signs of life that may wait for a tick; one more drops the oldest."""
BUS_VARIABLE, PROJECT_VARIABLE = "LUMEN_BUS", "LUMEN_PROJECT"
ROBOT_VARIABLE, MODULE_VARIABLE = "LUMEN_ROBOT", "LUMEN_MODULE"
"""The environment variables of a program that is started here: the bus's address if it is not only local, the project's
folder, the robot, and the module.
"""


class OwnModulePart(Part):
    """The part that watches one program; `happen` is called with `NAME.lost` and `NAME.found`.

    It starts the program if lumen.yaml has `here: true`, or if `starts` is set. `bus_url` is the address of the bus,
    empty if only this machine can reach it. `clock` returns real time [s].
    """

    def __init__(
        self,
        name: str,
        project: Project,
        bus: Bus,
        tell: Callable[[str, str], None],
        happen: Callable[[Event], None],
        *,
        bus_url: str = "",
        starts: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name, self._robot, self._bus, self._clock = name, project.robot, bus, clock
        self._settings = project.modules[name]
        self._tell, self._happen = tell, happen
        self._key = project.key_of(PRESENCE_ROUTE)
        self._session = uuid.uuid4().hex[:12]
        self._received: deque[Message] = deque(maxlen=MAX_PENDING_PRESENCES)
        self._undo = bus.subscribe(self._key, self._received.append)
        self._process: SupervisedProcess | None = None
        if starts or self._settings.here:
            folder, words = Path(project.root).absolute(), self._settings.command
            self._process = SupervisedProcess(name, words, folder, self._environment(folder, bus_url), clock=clock)
        self._heard, self._gone, self._known = -1.0, False, self._process is not None
        self._lost_at: float | None = None
        self._alive_at, self._since, self._next_presence = clock(), time.time(), 0.0
        self._reason, self._starts = "", 0

    @property
    def status(self) -> dict[str, Any]:
        """The program's state for `lumen status`: `here`, `lost` or `awaited`, since when, and why it was lost.

        A program that is started here also has the number of its restarts.
        """
        state = "lost" if self._lost_at is not None else "here" if self._heard >= 0 or self._running else "awaited"
        told = {"module": self.name, "state": state, "since": iso_time(self._since), "reason": self._reason or None}
        return {**told, "restarts": max(0, self._starts - 1)} if self._process else told

    def begin(self, now: float) -> None:
        self._alive_at, self._since = self._clock(), time.time()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        clock = self._clock()
        self._listen(clock)
        ended = self._supervise()
        if ended or not self._alive(clock):
            self._lose(ended or self._silence(), clock)
        elif self._heard >= 0 or self._running:
            self._find(clock)
        self._attend(clock)

    def quiet_until(self, now: float) -> float:
        return now + PRESENCE_PERIOD

    def summary(self) -> Iterator[str]:
        if self._lost_at is not None:
            yield f"{self.name}: lost at the end: {self._reason}"

    def close(self) -> None:
        self._undo()
        if self._process:
            self._process.close()
            self._print(self._process)
            if not self._settings.health:
                self._publish(LEAVES)

    @property
    def _running(self) -> bool:
        return self._process is not None and self._process.running

    def _supervise(self) -> str:
        """Start the program when it is due, and print its lines; return why it ended, else an empty string."""
        if self._process is None:
            return ""
        began = self._process.began
        ended = self._process.tick()
        self._print(self._process)
        if self._process.began != began:
            self._starts += 1
            self._heard, self._gone, self._session = -1.0, False, uuid.uuid4().hex[:12]
        if ended:
            pause = max(0.0, self._process.next - self._clock())
            self._tell(self.name, f"{ended}; the next attempt is in {pause:.0f} s")
        return ended

    def _print(self, process: SupervisedProcess) -> None:
        for line in process.lines():
            self._tell(self.name, line)

    def _listen(self, clock: float) -> None:
        """Read the signs of life that arrived."""
        while self._received:
            match self._received.popleft().body:
                case {"robot": self._robot, "parts": list(parts), "state": str(state), "session": str(session)} if (
                    self.name in parts and session != self._session
                ):
                    self._heard, self._gone, self._known = clock, state == LEAVES, True

    def _alive(self, clock: float) -> bool:
        """Return whether the program may still be there; one that has never appeared is only awaited."""
        if self._process and not self._settings.health:
            return self._running or self._lost_at is None
        if self._gone and self._running:
            return clock - self._heard <= END_TIMEOUT  # the program has announced its end, and gets time for it
        if not self._known or self._gone:
            return not self._known
        health = self._settings.health or DEFAULT_HEALTH
        if self._heard >= 0:
            return clock - self._heard <= health
        if self._process is None or not self._running:
            return self._lost_at is None
        return clock - self._process.began <= max(START_TIMEOUT, health)

    def _silence(self) -> str:
        """Return why a program that has not ended is lost."""
        if self._gone:
            return "it has left"
        return f"it sent no sign of life for {self._settings.health or DEFAULT_HEALTH:g} s"

    def _lose(self, reason: str, clock: float) -> None:
        if self._running and self._process:  # the program hangs, or has lost its bus
            self._process.restart()
        if self._lost_at is not None:
            return
        self._lost_at, self._since, self._reason = clock, time.time(), reason
        seconds = round(max(0.0, clock - self._alive_at), 3)
        if self._process is None or self._running:
            self._tell(self.name, f"is lost: {reason}")
        self._happen(Event(f"{self.name}.lost", {"seconds": seconds, "reason": reason}))

    def _find(self, clock: float) -> None:
        """Record that the program is there.

        After a loss, it counts as there once it has sent a sign of life or, if it sends none, has run for STEADY.
        """
        if self._lost_at is None:
            self._alive_at = clock
            return
        waits = self._heard < 0 if self._settings.health or self._process is None else False
        if waits or (self._process and not self._settings.health and clock - self._process.began < STEADY):
            return
        seconds = round(clock - self._lost_at, 3)
        self._lost_at, self._alive_at, self._since, self._reason = None, clock, time.time(), ""
        self._tell(self.name, f"is found again, after {seconds:.1f} s")
        self._happen(Event(f"{self.name}.found", {"seconds": seconds}))

    def _attend(self, clock: float) -> None:
        """Publish the presence of a program that sends no signs of life itself, while it runs."""
        if self._running and not self._settings.health and clock >= self._next_presence:
            self._next_presence = clock + PRESENCE_PERIOD
            self._publish(HERE)

    def _publish(self, state: str) -> None:
        body = {
            "robot": self._robot,
            "parts": [self.name],
            "session": self._session,
            "state": state,
            "host": platform.node(),
            "process": os.getpid(),
        }
        try:
            self._bus.publish(self._key, body, ttl=PRESENCE_TTL)
        except BusError:
            return  # the bus reports that it is gone

    def _environment(self, folder: Path, bus_url: str) -> Mapping[str, str]:
        """Return the program's environment: `python3` is this Python, and its output is not buffered."""
        found = dict(os.environ)
        found.pop(BUS_VARIABLE, None)
        path = f"{os.path.dirname(sys.executable)}{os.pathsep}{found.get('PATH', os.defpath)}"
        own = {PROJECT_VARIABLE: str(folder), ROBOT_VARIABLE: self._robot, MODULE_VARIABLE: self.name}
        bus = {BUS_VARIABLE: bus_url} if bus_url else {}
        return {**found, **own, **bus, "PATH": path, "PYTHONUNBUFFERED": "1"}


def statuses(parts: Sequence[Part]) -> list[dict[str, Any]]:
    """Return the status of the project's own modules among these parts."""
    return [part.status for part in parts if isinstance(part, OwnModulePart)]
