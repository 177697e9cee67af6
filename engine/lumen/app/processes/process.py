"""One process of an exhibition: its parts in one loop, among the processes that have the others."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from lumen.app.garbage import GcScheduler
from lumen.app.processes.claiming import CLAIM, refuse
from lumen.app.processes.part import Part
from lumen.buses.validated import ValidatedBus
from lumen.cli.main import STARTED
from lumen.cli.performance import clock_time
from lumen.errors import UsageError
from lumen.language.projects import Project
from lumen.ports import Clock
from lumen.robots.robot_routes import COMMAND, key_of
from lumen.runtime.loop import TICK
from lumen.runtime.presence import ROBOT, Presence, told
from lumen.runtime.trace_publisher import KEY


class Process:
    """Runs its parts until one is over or somebody ends it; `run` returns the exit code."""

    def __init__(
        self,
        project: Project,
        bus: ValidatedBus,
        place: str,
        clock: Clock,
        presence: Presence,
        parts: Sequence[Part],
        speed: float,
    ) -> None:
        self._project, self._bus, self._place, self._clock = project, bus, place, clock
        self._presence, self._parts, self._speed = presence, parts, speed
        self._now, self._asked = clock.now(), time.monotonic()
        self._begun: list[Part] = []
        self._waiting = ""
        self._gc_scheduler: GcScheduler | None = None
        self._interrupts, self._heeded, self._leaving = 0, 0, False
        self.after: list[Callable[[], None]] = []
        self.closing: list[Callable[[], None]] = []

    @property
    def over(self) -> bool:
        """Whether one of its parts is at its end."""
        return any(part.over for part in self._begun)

    @property
    def failed(self) -> bool:
        """Whether a story has failed, or was not played to its end."""
        return any(part.failed for part in self._begun)

    @property
    def leaving(self) -> bool:
        """Whether it was ended so that the next run goes on where this one was."""
        return self._leaving

    def interrupt(self, times: int = 1, *, leave: bool = False) -> None:
        """Ctrl-C: once rests the robot where there is one to rest, twice ends."""
        self._interrupts += times
        self._leaving = leave

    def run(self, period: float | None) -> int:
        """Until a part is over, the period [s] is, or the operator ends it."""
        began, now = self._now, self._now
        try:
            while not self._over(now - began, period):
                now = self.step()
        finally:
            self.close()
        print(f"\n{'The story failed' if self.failed else 'Ended'}: {clock_time(now - began)}.")
        for part in self._begun:
            part.summary()
        return 1 if self.failed and not self._interrupts else 0

    def step(self) -> float:
        """Live through a tick; its time [s]."""
        self._clock.wait(self._now + TICK)
        self._now = self._clock.now()
        self._tick(self._now)
        if self._gc_scheduler:
            self._gc_scheduler()
        return self._now

    def use(self, project: Project) -> None:
        """Go on with the bundle that the brain has put in force."""
        self._project = project
        self._bus.use(project)
        for part in self._parts:
            part.use(project)

    def close(self) -> None:
        with ExitStack() as stack:
            stack.callback(self._bus.close)
            stack.callback(self._presence.close)
            for close in [*(part.close for part in self._parts), *self.closing]:
                stack.callback(close)

    def _tick(self, now: float) -> None:
        changes = self._presence.tick()
        if not self._presence.settled:
            self._claim()
        for follow in self.after:
            follow()
        for part in self._parts:
            if part in self._begun:
                part.tick(now, changes)
            elif self._presence.settled and self._ready(part):
                self._check_speed()
                part.begin(now)
                self._begun.append(part)
        self._heed()

    def _claim(self) -> None:
        """Be what we want to be, unless another process is. Raises UsageError there."""
        refuse(self._presence)
        if time.monotonic() - self._asked < CLAIM:
            return
        self._presence.settle()
        self._gc_scheduler = GcScheduler()
        self.closing.append(self._gc_scheduler.close)
        ready = time.monotonic() - STARTED
        what = ", ".join(self._presence.parts)
        print(f"{self._project.name}: {what} of {self._project.robot}, on {self._place}, ready after {ready:.1f} s.")

    def _ready(self, part: Part) -> bool:
        """Whether those are there that it needs; where not, that is said once."""
        for need in part.needs:
            if need not in self._presence.parts and not self._here(need):
                key = key_of(self._project, COMMAND) if need == ROBOT else KEY
                line = f"waiting for the {need} on {key}"
                if line != self._waiting:
                    self._waiting = line
                    print(line, flush=True)
                return False
            if need in self._presence.parts and not any(p.name == need for p in self._begun):
                return False
        return True

    def _here(self, need: str) -> bool:
        peer = self._presence.find(need)
        return peer is not None and peer.state == "here"

    def _check_speed(self) -> None:
        """Raises UsageError where the others' time runs at another speed."""
        for peer in self._presence.peers():
            theirs = peer.said.get("speed")
            if isinstance(theirs, int | float) and theirs != self._speed:
                raise UsageError(f"{told(peer)} runs at {theirs:g} × real time: say --speed {theirs:g} here, too")

    def _over(self, lived: float, period: float | None) -> bool:
        if self._interrupts > 1 or (period is not None and lived >= period):
            return True
        return self.over

    def _heed(self) -> None:
        """What the first Ctrl-C asks for; where nobody has anything to do for it, it ends."""
        if self._interrupts == 1 and not self._heeded:
            self._heeded = 1
            heeded = [part.interrupt() for part in self._begun]
            if not any(heeded):
                self._interrupts = 2
