"""Measure the cost of the input journal, and the speed of its replay.

    python benchmarks/journal.py

Times are CPU times of this process, including its threads. The visits are those of the shipped tour's story, one after
another: faces many times per second, words, answers of the robot.

`a core at 200 events/s`: the additional CPU time of an event with the journal, times 200. `worst tick`: the longest of
1,000 ticks with an event each, 200 per second, without and with the journal. `30 days`: the disk space of a second of a
visit, times the seconds of 30 days with nine opening hours and a permanent visitor. `a day`: nine hours of visits,
replayed with the same files and with others.
"""

import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median

import lumen
from lumen.insight.replay.entries import RecordedEntry
from lumen.journal.journal_file import read_journal
from lumen.journal.journal_folder import JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.run.loop import Observer
from lumen.run.rehearsal import rehearse
from lumen.run.replaying.other_files import against
from lumen.run.replaying.replay_report import replayed
from lumen.run.runtime import Runtime
from lumen.run.watcher import SWITCH_INTERVAL

ROOT = Path(__file__).parents[1]
EVENTS_PER_SECOND = 200
HOURS, DAYS = 9, 30
ROUNDS = 5
TICKS = 1_000


class Ticks(Observer):
    """Collects the events of a story, as `Runtime.tick` receives them."""

    def __init__(self) -> None:
        self.events: list[Event] = []

    def stepped(self, step: object) -> None:
        """Collect the event of a step, unless it is a timer's."""
        event = getattr(step, "event", None)
        if event and not event.sendid:
            self.events.append(event)


def visit(project: Project) -> list[Event]:
    """Return the events that the behaviour receives in one visit."""
    ticks = Ticks()
    rehearse(project, project.stories[project.story], observers=[ticks])
    return ticks.events


def worst_tick(project: Project, events: Sequence[Event], folder: Path | None) -> float:
    """Return the longest tick [s], at a rate of `EVENTS_PER_SECOND`."""
    runtime = Runtime(project)
    writer = JournalWriter(JournalFolder(folder, 30.0, 1e9)) if folder else None
    if writer:
        writer.start()
        runtime.recorder = writer
    runtime.start(0.0, epoch=1.78e9)
    usual, worst, begun = sys.getswitchinterval(), 0.0, time.perf_counter()
    sys.setswitchinterval(SWITCH_INTERVAL)
    for number, event in enumerate(events[:TICKS]):
        time.sleep(max(0.0, begun + number / EVENTS_PER_SECOND - time.perf_counter()))
        tick = time.perf_counter()
        runtime.tick(event.at, [event])
        worst = max(worst, time.perf_counter() - tick)
    sys.setswitchinterval(usual)
    if writer:
        writer.close()
    return worst


def run(project: Project, events: Sequence[Event], times: int, folder: Path | None) -> tuple[float, float]:
    """Return CPU time and simulated time of that many visits [s]; with a folder, they are journaled."""
    runtime = Runtime(project)
    writer = JournalWriter(JournalFolder(folder, 30.0, 1e9), rehearsed=True) if folder else None
    if writer:
        writer.start()
        runtime.recorder = writer
    length = events[-1].at + 20.0
    runtime.start(0.0, epoch=1.78e9)
    began = time.process_time()
    for number in range(times):
        offset = number * length
        counters = runtime.snapshot.counters
        for event in events:
            moved = renamed(event, number, counters.commands, counters.awaited)._replace(at=offset + event.at)
            runtime.tick(moved.at, [moved])
    if writer:
        writer.close(60.0)
    return time.process_time() - began, times * length


def renamed(event: Event, number: int, commands: int, awaited: int) -> Event:
    """Return an answer of the first visit with the id of the corresponding command of this visit."""
    kind, separator, id = event.name.partition(".command.")
    if not separator or number == 0:
        return event
    return event._replace(name=f"{kind}.command.{id[0]}{int(id[1:]) + (commands - 2 if id[0] == 'c' else awaited)}")


def entries(folder: Path) -> list[RecordedEntry]:
    """Return all entries of the journals in a folder."""
    return [entry for file in JournalFolder(folder, 30.0, 1e9).files() for entry in read_journal(file).entries]


class Bundles:
    """A source of projects and machines that has only one bundle."""

    def __init__(self, bundle: Project) -> None:
        self._bundle = bundle

    def project(self, hash: str, behavior: str) -> Project:
        """Return the project of the bundle."""
        return self._bundle

    def machine(self, hash: str, behavior: str) -> MachineDefinition:
        """Return the machine of the bundle."""
        return self._bundle.machine


def main() -> None:
    project = lumen.load(ROOT)
    events = visit(project)
    print(f"a visit: {len(events):,} events in {events[-1].at:.0f} s")
    costs = list[float]()
    worst: tuple[list[float], list[float]] = ([], [])
    times = max(1, 20_000 // len(events))
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as folder:
            without, _ = run(project, events, times, None)
            with_it, _ = run(project, events, times, Path(folder))
        costs.append((with_it - without) / (times * len(events)))
        with tempfile.TemporaryDirectory() as folder:
            worst[0].append(worst_tick(project, events, None))
            worst[1].append(worst_tick(project, events, Path(folder)))
    share = median(costs) * EVENTS_PER_SECOND
    print(f"a core at {EVENTS_PER_SECOND} events/s: {share:.2%} ({median(costs) * 1e6:.0f} us an event), wanted < 2 %")
    ticks = [f"{median(row) * 1e3:.2f} ms" for row in worst]
    print(f"worst tick, median of {ROUNDS} runs: {ticks[0]} without, {ticks[1]} with the journal")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        length = events[-1].at + 20.0
        _, lived = run(project, events, int(HOURS * 3600 / length) + 1, folder)
        size = sum(file.stat().st_size for file in folder.glob("*.journal"))
        kept = size / lived * HOURS * 3600 * DAYS / 1e9
        print(f"{DAYS} days of {HOURS} h: {kept:.2f} GB ({size / lived:.0f} B/s), wanted < 2 GB")
        began = time.process_time()
        again = replayed(entries(folder), Bundles(project).machine)
        took = time.process_time() - began
        print(f"a day of {HOURS} h, replayed: {took:.1f} s; {again.same} of {again.visits} visits the same")
        other = replace(project, hash="other")
        began = time.process_time()
        report = against(entries(folder), Bundles(project), other)  # type: ignore[arg-type]  # what is asked of them
        took = time.process_time() - began
        print(f"a day of {HOURS} h, with other files: {took:.1f} s, wanted < 10 s; {report.same} visits the same")


if __name__ == "__main__":
    sys.exit(main())
