"""Run a tour under load while its files are edited in every way in which editors save; a third of the edits are broken.

    python benchmarks/reload.py [--edits N] [--bus URL] [--quiet SECONDS] [--seed N]

The robot's head follows a visitor, the behaviour counts 200 events a second, and a writer makes one edit after the
other, each as soon as the one before has its verdict. The running files must always be a valid state that the writer
completed; no event may be lost; nothing may grow.
"""

import argparse
import os
import platform
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from statistics import quantiles
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from editing import Colleague, project
from tests.guarded import PIPE, Guarded

import lumen
from lumen.bus import connect
from lumen.clock.simulated import SimulatedClock
from lumen.language.events import Event
from lumen.language.stories import Visitor
from lumen.project.home import Home
from lumen.robot.recording import RecordingRobot
from lumen.run.exhibition import Exhibition
from lumen.run.loop import TICK_PERIOD
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader, ReloadOptions
from lumen.run.reload.report import ReloadReport
from lumen.run.reload.saved_files import RecordsPart, ReloadPart
from lumen.run.setup import Setup
from lumen.run.watcher import SHORT_QUIET_FRACTION
from lumen.upkeep.garbage import GcScheduler

RATE = 200
PATIENCE = 60.0
WARM = 0.4
"""The part of the edits after which memory, threads and files are counted for the first time."""


@dataclass
class Outcome:
    """The observations of a soak; times in [s]."""

    edits: int
    broken: int = 0
    sent: int = 0
    counted: int = 0
    """The number of sent events that the behaviour counted."""
    ticks: int = 0
    missed: int = 0
    """The number of ticks that began more than two periods after the tick before."""
    gap: float = 0.0
    """The longest time between the beginnings of two ticks."""
    beside: int = 0
    """The number of ticks that a process beside this one missed, which only ticks."""
    wrong: list[str] = field(default_factory=list)
    """A sentence for each wrong verdict, and one if the writer failed."""
    applied: int = 0
    refused: int = 0
    waited: int = 0
    """The number of verdicts `waiting`: the files are good, but the robot can't change yet."""
    unanswered: int = 0
    """The number of edits without a final verdict within `PATIENCE`."""
    single: list[float] = field(default_factory=list)
    """Times from a good edit of one file to its first verdict."""
    verdicts: list[float] = field(default_factory=list)
    """The same times for all other edits."""
    own: list[float] = field(default_factory=list)
    """The part of each of these times that the validation took."""
    swaps: list[float] = field(default_factory=list)
    """The time that each applied change took on the running thread."""
    memory: tuple[int, int] = (0, 0)
    """The memory of this process after `WARM` of the edits, and at the end [bytes]; so `threads` and `handles`."""
    threads: tuple[int, int] = (0, 0)
    handles: tuple[int, int] = (0, 0)
    """The numbers of open files."""

    @property
    def lost(self) -> int:
        """Return the number of events that were sent but not counted."""
        return self.sent - self.counted

    @property
    def growth(self) -> float:
        """Return the growth of the resident memory [%]."""
        before, after = self.memory
        return 100.0 * (after - before) / before if before else 0.0


class Told(NamedTuple):
    """A verdict: its time, the hash of its files, and the durations of validation (`own`) and swap; times in [s]."""

    at: float
    verdict: str
    hash: str
    own: float
    swap: float
    reason: str


def told_of(report: ReloadReport, at: float) -> Told:
    """Return the verdict in a report that arrived at `at` [s]."""
    own = report.validation.took if report.validation else 0.0
    reason = next(report.lines(), "")
    return Told(at, report.verdict, report.after, own, report.took.get("applying", 0.0), reason)


METRONOME = f"""
import sys, threading, time
ended, missed, before = threading.Event(), 0, time.monotonic()
threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
while not ended.is_set():
    time.sleep({TICK_PERIOD})
    now = time.monotonic()
    missed, before = missed + (now - before > {2 * TICK_PERIOD}), now
print(missed)
"""


@contextmanager
def metronome() -> Iterator[list[int]]:
    """Run a process that only ticks; when it has ended, the yielded list holds its number of missed ticks."""
    missed: list[int] = []
    with Guarded([sys.executable, "-c", METRONOME], stdin=PIPE, stdout=PIPE) as process:
        yield missed
        told, _ = process.communicate()
        missed.append(int(told))


class Load(threading.Thread):
    """Sends numbered events on a bus of its own, `RATE` per second."""

    def __init__(self, show: Exhibition, url: str) -> None:
        super().__init__(daemon=True)
        self.sent, self.ended = 0, threading.Event()
        self._bus = show.loop.bus if url.startswith("memory") else connect(url)
        self._own = not url.startswith("memory")

    def run(self) -> None:
        """Send events until `ended` is set."""
        due = time.monotonic()
        while not self.ended.wait(max(0.0, due - time.monotonic())):
            self._bus.publish("lumen.load", {"number": self.sent})
            self.sent += 1
            due += 1 / RATE
        if self._own:
            self._bus.close()


class LookPart(Part):
    """Calls a function after all other parts of a tick, so that it sees the results of the tick."""

    def __init__(self, look: Callable[[], None]) -> None:
        self._look = look

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Call the function."""
        self._look()


class Soak:
    """A show in real time with a writer that edits its files."""

    def __init__(self, root: Path, url: str, quiet: float, seed: int, edits: int) -> None:
        bundle = lumen.load(root)
        robot = RecordingRobot(bundle.body)
        setup, bare = Setup(robot, SimulatedClock(robot.advance, 1.0), robot), {"operated": False}
        self.show = Exhibition(Plan(bundle, setup, url, options=bare))
        narrator = Narrator(self.show.loop.clock.now, lambda: bundle.machine)
        home = Home(root / ".lumen")
        home.hold()
        records = RunRecords(home)
        self.reloading = Reloader(self.show.behavior, narrator, ReloadOptions(quiet=quiet), records=records)
        parts = self.show.node.parts
        parts.insert(parts.index(self.show.brain), ReloadPart(self.reloading))
        parts += [RecordsPart(records, self.show.behavior, lasts=True), LookPart(self.look)]
        self.outcome, self.writer = Outcome(edits), Colleague(root, seed, 0.8 * SHORT_QUIET_FRACTION * quiet)
        self.closing = ExitStack()
        for close in (home.release, records.close, self.show.close, self.writer.close):
            self.closing.callback(close)
        self.load = Load(self.show, url)
        self._told: list[Told] = []
        self._last: ReloadReport | None = None
        self._before = time.monotonic()
        self._running = bundle.hash
        self._verdict = threading.Event()
        self._editing = threading.Thread(target=self.edit, daemon=True)
        self._done, self._pause = threading.Event(), threading.Event()

    def look(self) -> None:
        """Observe each tick, verdict and bundle, on the running thread."""
        now, outcome = time.monotonic(), self.outcome
        gap, self._before = now - self._before, now
        if not self._done.is_set():
            outcome.ticks += 1
            outcome.gap = max(outcome.gap, gap)
            outcome.missed += gap > 2 * TICK_PERIOD
        if self.reloading.last is not self._last and self.reloading.last:
            self._last = self.reloading.last
            self._told.append(told_of(self._last, now))
            self._verdict.set()
        hash = self.show.loop.project.hash
        if hash != self._running:
            self._running = hash
            self._applied = hash

    _applied = ""

    def edit(self) -> None:
        """Make all edits on the writer's thread, until one fails."""
        try:
            for number in range(1, self.outcome.edits + 1):
                self.edit_once(number)
        except Exception as error:
            self.outcome.wrong.append(f"the writer failed: {error!r}")
            raise
        finally:
            self._done.set()

    def edit_once(self, number: int) -> None:
        """Make an edit, and wait for the verdict."""
        seen = len(self._told)
        hash, good, files = self.writer.edit()
        saved, single = time.monotonic(), good and files == 1
        self.outcome.broken += not good
        self.wait(hash, saved, seen, self.outcome.single if single else self.outcome.verdicts)
        if number == max(1, int(WARM * self.outcome.edits)):
            self.count(0)

    def wait(self, hash: str, saved: float, seen: int, verdicts: list[float]) -> None:
        """Wait for the final verdict on the files with this hash; append the time to their first one to `verdicts`."""
        outcome, deadline = self.outcome, saved + PATIENCE
        first = True
        while time.monotonic() < deadline:
            while seen < len(self._told):
                told = self._told[seen]
                seen += 1
                self.check(told)
                if told.hash != hash:
                    continue
                if first:
                    verdicts.append(told.at - saved)
                    outcome.own.append(told.own)
                    first = False
                if told.verdict != "waiting":
                    return
                outcome.waited += 1
            self._verdict.wait(0.5)
            self._verdict.clear()
        outcome.unanswered += 1

    def check(self, told: Told) -> None:
        """Count a verdict, and note it in `wrong` if the writer's files do not justify it."""
        outcome = self.outcome
        if told.verdict == "applied":
            outcome.applied += 1
            outcome.swaps.append(told.swap)
            if told.hash not in self.writer.good:
                outcome.wrong.append(f"applied {told.hash[:8]}, which the writer never completed, or broke")
        elif told.verdict == "refused":
            outcome.refused += 1
            if told.hash in self.writer.good:
                outcome.wrong.append(f"refused good files: {told.reason}")

    def count(self, place: int) -> None:
        """Record memory [bytes], threads and open files of this process: at place 0 after warming up, 1 at the end."""
        import gc

        gc.collect()
        memory = int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        handles = min(len(os.listdir("/proc/self/fd")) for _ in range(5) if not self._pause.wait(0.05))
        found = memory, threading.active_count(), handles  # the minimum excludes files that are only being read
        for name, value in zip(("memory", "threads", "handles"), found, strict=True):
            both = list(getattr(self.outcome, name))
            both[place] = value
            setattr(self.outcome, name, tuple(both))

    def run(self) -> Outcome:
        """Run the show until all edits are made and all events counted; return the observations."""
        show, outcome = self.show, self.outcome
        try:
            show.start()
            assert show.visitor
            show.visitor.arrive(Visitor())
            self.load.start()
            tidy = self.closing.enter_context(closing(GcScheduler()))
            self.until(time.monotonic() + 2.0)
            outcome.missed, outcome.gap, outcome.ticks = 0, 0.0, 0
            with metronome() as beside:
                self._editing.start()
                while not self._done.is_set():
                    show.tick()
                    tidy()
            outcome.beside = beside[0]
            self.count(1)
            self.load.ended.set()
            self.load.join()
            outcome.sent = self.load.sent
            deadline = time.monotonic() + PATIENCE
            while self.counted() < outcome.sent and time.monotonic() < deadline:
                show.tick()
            outcome.counted = self.counted()
        finally:
            self.closing.close()
        return outcome

    def until(self, deadline: float) -> None:
        """Tick until a time of the monotonic clock [s]."""
        while time.monotonic() < deadline:
            self.show.tick()

    def counted(self) -> int:
        """Return the number of events that the behaviour has counted."""
        return int(self.show.loop.runtime.snapshot.context["loaded"])


def soak(edits: int, url: str = "memory://", quiet: float = 0.3, seed: int = 1) -> Outcome:
    """Make that many edits; return the observations."""
    with project() as root:
        return Soak(root, url, quiet, seed, edits).run()


def _spread(times: list[float]) -> str:
    if len(times) < 2:
        return "no measure"
    cuts = quantiles(times, n=20, method="inclusive")
    return f"p50 {1000 * cuts[9]:.0f} ms, p95 {1000 * cuts[18]:.0f} ms, worst {1000 * max(times):.0f} ms"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--edits", type=int, default=50)
    parser.add_argument("--bus", default="memory://")
    parser.add_argument("--quiet", type=float, default=0.3)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    began = time.monotonic()
    found = soak(options.edits, options.bus, options.quiet, options.seed)
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    print(f"{found.edits} edits ({found.broken} broken) in {time.monotonic() - began:.0f} s on {options.bus}")
    print(f"applied {found.applied}, refused {found.refused}, waited for the robot {found.waited}", end="")
    print(f", without a verdict {found.unanswered}")
    print(f"wrong or mixed bundles applied  {len(found.wrong)}")
    print(f"events lost                     {found.lost} of {found.sent:,}")
    print(f"ticks missed                    {found.missed} of {found.ticks:,}", end="")
    print(f" (longest {1000 * found.gap:.0f} ms); a process that only ticks missed {found.beside} beside it")
    print(f"saved to verdict, one good file {_spread(found.single)}")
    print(f"  broken, or several files      {_spread(found.verdicts)}, after {1000 * options.quiet:.0f} ms of quiet")
    print(f"our own work                    {_spread(found.own)}")
    print(f"swap                            {_spread(found.swaps)} (a tick is {1000 * TICK_PERIOD:.0f} ms)")
    before, after = (size / 2**20 for size in found.memory)
    print(f"memory                          {before:.1f} -> {after:.1f} MiB ({found.growth:+.1f} %)")
    print(f"threads, files open             {found.threads[0]} -> {found.threads[1]}", end="")
    print(f", {found.handles[0]} -> {found.handles[1]}")
    for line in found.wrong[:10]:
        print(f"  {line}")


if __name__ == "__main__":
    main()
