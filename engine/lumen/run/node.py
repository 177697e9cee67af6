"""One process of an exhibition: its parts in one loop, alone or among processes with the other parts."""

import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack, closing
from dataclasses import dataclass
from math import ceil, inf

from lumen.bus.validated import ValidatedBus
from lumen.clock.following import FollowingClock
from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.language.nanoseconds import to_the_nanosecond
from lumen.language.projects import Project
from lumen.ports import Clock, CountsDrops, Dozes, MeasuresPace
from lumen.robot.robot_routes import COMMAND_ROUTE
from lumen.run.claiming import CLAIM_DURATION, refuse_rivals, refuse_silence
from lumen.run.living import ROUNDING, live
from lumen.run.loop import TICK_PERIOD
from lumen.run.nap import Nap
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.presence import HERE, ROBOT_PART, Presence, where_it_runs
from lumen.run.trace_publisher import TRACE_ROUTE
from lumen.upkeep.garbage import GcScheduler
from lumen.upkeep.threads import ThreadWatch, WatchedThread

SLOW, WELL = 0.95, 0.98
"""The shares of its nominal speed below which a clock is slow, and above which it has recovered [1]."""
LOOK_PERIOD = 1.0
"""The time between two checks of the pace [s]."""


class PaceWatch:
    """A watch over the share of its nominal speed that a clock reaches; a clock that can't measure it counts as 1."""

    def __init__(self, clock: Clock, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._monotonic, self._next = clock, monotonic, 0.0
        self.slow, self.worst = False, 1.0

    @property
    def realtime(self) -> float:
        """The recent share of its nominal speed that the clock reaches, at most 1."""
        return round(min(1.0, self._clock.realtime if isinstance(self._clock, MeasuresPace) else 1.0), 3)

    def tick(self) -> str:
        """Return a line if the share has fallen below SLOW or risen above WELL again, else an empty string."""
        if self._monotonic() < self._next:
            return ""
        self._next = self._monotonic() + LOOK_PERIOD
        now = self.realtime
        self.worst = min(self.worst, now)
        if not self.slow and now < SLOW:
            self.slow = True
            return (
                f"the exhibition is running at only {now:.2f} × real time:"
                " this machine is too slow or too busy, so everything is late"
            )
        if self.slow and now > WELL:
            self.slow = False
            return "the exhibition is running in real time again"
        return ""

    def summary(self) -> list[str]:
        """Return a line about the slowest pace; empty if it was not below SLOW."""
        return [f"at its slowest, the exhibition ran at {self.worst:.2f} × real time"] if self.worst < SLOW else []


NAP = 0.2
"""The longest sleep while nothing is due [s], and so the longest delay of an input that does not wake the loop."""


@dataclass(frozen=True, slots=True)
class NodeTime:
    """How time passes in a process."""

    speed: float | None = None
    """The speed that other processes must have too, as a multiple of real time; None if any speed is allowed."""
    leaps: bool = False
    """Whether ticks in which nothing happens are skipped."""
    paced: Callable[[float], None] = lambda _: None
    """Called with the share of real time when it becomes slow or recovers."""


EVERY_TICK = NodeTime()


class Node:
    """A loop that ticks its parts in order until one is over or the loop is interrupted twice.

    With a `presence` it is one of several processes, or a whole exhibition visible to others on the bus, and begins
    after its claim. The functions in `before` are called at each tick with its time [s], before the parts. In real time
    `run` sleeps until something is due, or until an arriving message ends `nap`.
    """

    def __init__(
        self,
        project: Project,
        bus: ValidatedBus,
        clock: Clock,
        narrator: Narrator,
        *,
        presence: Presence | None = None,
        nap: Nap | None = None,
        before: Sequence[Callable[[float], None]] = (),
        time_passes: NodeTime = EVERY_TICK,
    ) -> None:
        self._project, self._clock, self._narrator, self._time = project, clock, narrator, time_passes
        self._dozes = clock if isinstance(clock, Dozes) else None
        self.bus, self.presence = bus, presence
        self.parts: list[Part] = []
        self.faults: list[str] = []
        """The faults of packages: parts that are stopped or left out, failures to forget a person, and subscribers."""
        self._before = before
        self._nap = nap or Nap()
        self.now, self._asked = clock.now(), time.monotonic()
        self._begun: list[Part] = []
        self._threads = ThreadWatch()
        self.pace = PaceWatch(clock)
        self._waiting = ""
        self._interrupts, self._heeded, self._leaving = 0, False, False

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self._project

    @property
    def over(self) -> bool:
        """Whether a part is over, or the process was interrupted twice."""
        return self._interrupts > 1 or any(part.over for part in self._begun)

    @property
    def failed(self) -> bool:
        """Whether a story has failed, or was interrupted before its end."""
        return any(part.failed for part in self._begun)

    @property
    def troubles(self) -> list[str]:
        """The troubles of the behaviour in this process; a story judges them itself."""
        return list(self._narrator.troubles)

    @property
    def interrupted(self) -> bool:
        """Whether the process was interrupted."""
        return self._interrupts > 0

    @property
    def leaving(self) -> bool:
        """Whether the process was ended so that the next run continues from here."""
        return self._leaving

    def interrupt(self, times: int = 1, *, leave: bool = False) -> None:
        """Handle Ctrl-C: the first rests a robot that is here, the second ends the run; safe in a signal handler.

        `times` is the number of interrupts to count. With `leave`, the next run continues from here.
        """
        self._interrupts += times
        self._leaving = leave

    def request(self) -> None:
        """Start the time within which another process can object to this process's roles."""
        self._asked = time.monotonic()

    def claims(self) -> bool:
        """Return whether other processes can still object to this process's roles.

        Raises UsageError if a process objects, BusUnreachableError if none could, because the broker accepts no
        messages.
        """
        if self.presence is None or self.presence.settled:
            return False
        self.presence.tick()
        self._claim(self.presence)
        return not self.presence.settled

    def begin(self) -> None:
        """Begin the parts that need no other process, after `claims` has returned False."""
        self._begin(self.now)

    def run(self, period: float | None = None) -> float:
        """Tick until the node is over, for at most `period` [s] (None: no limit); return how long it ran [s]."""
        with closing(GcScheduler()) as garbage:
            return live(self, period, garbage)

    def tick(self) -> float:
        """Wait for the next tick and run it; return its time [s]."""
        if self._time.leaps:
            self._leap()
        self._clock.wait(self.now + TICK_PERIOD)
        self.now = self._clock.now()
        changes: list[Event] = self.presence.tick() if self.presence else []
        if self.presence and not self.presence.settled:
            self._claim(self.presence)
        if self.presence and isinstance(self._clock, FollowingClock):
            self._follow(self._clock, self.presence)
        for call in self._before:
            call(self.now)
        if not self.presence or self.presence.settled:
            self._begin(self.now)
        for part in self._begun:
            part.tick(self.now, changes)
        for thread in self._threads.tick():
            self._lose(thread)
        self._keep_pace()
        self._on_interrupt()
        return self.now

    def nap(self, most: float = inf) -> None:
        """Sleep through ticks in which nothing happens, for at most `most` [s], until woken."""
        with self.napping(self):
            self.pass_over(self.doze(min(most, self.quiet_time())))

    def napping(self, on: "Node") -> AbstractContextManager[None]:
        """Return the context in which to nap on the clock of this node or of another one in this process."""
        return self._nap.on(on._dozes)

    def quiet_time(self) -> float:
        """Return for how long nothing happens without an input [s]; 0 if something may happen at once."""
        if self.presence and not self.presence.settled:
            return 0.0
        until = inf
        for part in self._begun:
            until = min(until, part.quiet_until(self.now))
            if until < self.now + 2 * TICK_PERIOD:
                return 0.0
        return until - self.now

    def doze(self, rest: float) -> int:
        """Sleep until woken, for at most the lesser of `rest` and NAP [s].

        Return the number of ticks slept; 0 if the clock can't doze.
        """
        if self._dozes is None or rest < 2 * TICK_PERIOD:
            return 0
        return int((self._dozes.doze(self.now + min(rest, NAP) - TICK_PERIOD) - self.now) / TICK_PERIOD + ROUNDING)

    def pass_over(self, ticks: int) -> None:
        """Advance the time by `ticks` ticks in which nothing happens."""
        if ticks > 0:
            self.now = to_the_nanosecond(self.now + ticks * TICK_PERIOD)
            self._clock.wait(self.now)
            for part in self._begun:
                part.leap(self.now)

    def _leap(self) -> None:
        """Skip the ticks before the next one in which something happens, if that time is known."""
        if (rest := self.quiet_time()) < inf:
            self.pass_over(ceil(rest / TICK_PERIOD - ROUNDING) - 1)

    def use(self, project: Project) -> None:
        """Switch the bus and every part to another bundle."""
        self._project = project
        self.bus.use(project)
        for part in self.parts:
            part.use(project)

    def close(self) -> None:
        """Close all parts, then the presence and the bus, even if one of them raises an error."""
        with ExitStack() as stack:
            stack.callback(self.bus.close)
            if self.presence:
                stack.callback(self.presence.close)
            for part in self.parts:
                stack.callback(part.close)

    def summary(self) -> list[str]:
        """Return the lines that the parts print at the end, and those of `losses`."""
        return [*(line for part in self._begun for line in part.summary()), *self.losses()]

    def losses(self) -> list[str]:
        """Return the lines for the end about slow time and dropped messages."""
        counts = self.bus.ability(CountsDrops)
        dropped = ", ".join(f"{count:,} on {key}" for key, count in sorted(counts.dropped.items() if counts else ()))
        return [*self.pace.summary(), *([f"dropped messages: {dropped}"] if dropped else [])]

    def _claim(self, presence: Presence) -> None:
        refuse_rivals(presence)
        refuse_silence(self.bus, presence)
        if time.monotonic() - self._asked >= CLAIM_DURATION:
            presence.settle()

    def _begin(self, now: float) -> None:
        for part in self.parts:
            if part not in self._begun and self._ready(part):
                self._check_speed()
                part.begin(now)
                self._begun.append(part)

    def _ready(self, part: Part) -> bool:
        """Return whether the parts that a part needs are there; if not, report that once."""
        for need in part.needs:
            if self.presence and need not in self.presence.parts and not self._here(self.presence, need):
                key = self._project.key_of(COMMAND_ROUTE if need == ROBOT_PART else TRACE_ROUTE)
                line = f"waiting for the {need} on {key}"
                if line != self._waiting:
                    self._waiting = line
                    self._narrator.note(line)
                return False
        return True

    def _here(self, presence: Presence, need: str) -> bool:
        peer = presence.find(need)
        return peer is not None and peer.state == HERE

    def _check_speed(self) -> None:
        """Raise UsageError if another process's time runs at a different speed."""
        for peer in self.presence.peers() if self.presence and self._time.speed else ():
            theirs = peer.said.get("speed")
            if isinstance(theirs, int | float) and theirs != self._time.speed:
                raise UsageError(
                    f"{where_it_runs(peer)} is running at {theirs:g} × real time: pass --speed {theirs:g} here, too"
                )

    def _lose(self, thread: WatchedThread) -> None:
        """Report a thread that can't be restarted; if it is vital, the robot rests, because no person could stop it."""
        self._narrator.line("trouble", thread.lost)
        if thread.vital:
            for part in self._begun:
                part.helpless(thread.lost)

    def _follow(self, clock: FollowingClock, presence: Presence) -> None:
        """Follow the robot's time if its process publishes it; tick the clock in any case."""
        robot = presence.find(ROBOT_PART)
        if robot and isinstance(at := robot.said.get("time"), int | float):
            clock.follow(robot.session, float(at), robot.heard)
        clock.tick()

    def _keep_pace(self) -> None:
        if isinstance(self._clock, FollowingClock):
            return  # the process with the robot's clock reports its pace
        if line := self.pace.tick():
            self._narrator.line("time", line)
            self._time.paced(self.pace.realtime)

    def _on_interrupt(self) -> None:
        """Pass the first interrupt on to the parts; if none of them handles it, end the run."""
        if self._interrupts == 1 and not self._heeded:
            self._heeded = True
            heeded = [part.interrupt() for part in self._begun]
            if not any(heeded):
                self._interrupts = 2
