"""The cost of a console, and the waiting times at its pages.

    python benchmarks/console.py [--only ticks|pages] [--robot simulation|recording] [--clients 50] [--seconds S]
                                 [--rounds N] [--against FOLDER]

Ticks: the shipped tour runs with its visitor in real time; the console and the listening pages are separate
processes. One of the pages never reads. The delay of a tick is the time since the 50th of a second at which it was
due. The table has the 99th percentile, the latest tick, and the number of ticks that were a whole period late.

A busy machine has late ticks without a console, too, so they are measured in pairs: each run has a block without and
a block with the console, in alternating order. `more` is the number of additional late ticks in the block with the
console: the median of the runs, and the quartiles. If 0 is between the quartiles, the console causes no late ticks.
Watchers request the camera's images, like pages that show them.

Pages: console_pages.py describes them. They need Chromium. `--against` measures another checkout in the same run.
"""

import argparse
import json
import os
import platform
import shutil
import socket
import statistics
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from console_pages import print_pages, quartiles
from tests.guarded import DEVNULL, PIPE, Guarded, temporary_folder

import lumen
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS
from lumen.run.exhibition import Exhibition
from lumen.run.loop import TICK_PERIOD
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import set_up

ROOT = Path(__file__).parents[1]
SETTLED = 3.0
"""Time before the measurement [s]."""
TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
WATCHERS = 5


class Round(NamedTuple):
    """The measurements of one block."""

    p99: float
    """99th percentile of the delay of ticks [s]."""
    latest: float
    """Greatest delay of a tick [s]."""
    late: float
    """Number of ticks late by a whole period."""
    exhibition: float
    """CPU time of the exhibition per second [s]."""
    console: float
    """CPU time of the console per second [s]."""
    page: float
    """Bytes per second of a page."""
    watcher: float
    """Bytes per second of a watcher."""


class Pair(NamedTuple):
    """A run's block without a console, and its block `having` one."""

    without: Round
    having: Round


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", choices=("recording", "simulation"), default="simulation")
    parser.add_argument("--clients", type=int, default=50, help="pages that listen, of which one never reads")
    parser.add_argument("--seconds", type=float, default=8.0, help="how long a block is")
    parser.add_argument("--rounds", type=int, default=5, help="runs of each kind, a block with and one without each")
    parser.add_argument("--only", choices=("ticks", "pages"), help="measure only these")
    parser.add_argument("--against", type=Path, help="another checkout, whose pages are measured in turns with these")
    parser.add_argument("--listen", nargs=3, metavar=("PORT", "PAGES", "WATCHERS"), help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.listen:
        listen(*map(int, asked.listen))
        return
    print(f"{platform.machine()}, {os.cpu_count()} cores, CPython {platform.python_version()}")
    if asked.only != "pages":
        print_ticks(asked)
    if asked.only != "ticks":
        print_pages(asked.rounds, asked.seconds, asked.against)


def print_ticks(asked: argparse.Namespace) -> None:
    """Measure the blocks, and print a table of them."""
    ticks = round(asked.seconds / TICK_PERIOD)
    print(f"ticks of the {asked.robot} robot: medians of {asked.rounds} runs of two blocks of {asked.seconds:g} s\n")
    kinds = {"nobody looks": (0, 0), "1 page": (1, 0), f"{asked.clients} pages": (asked.clients, 0)}
    if asked.robot == "simulation":
        kinds |= {f"and {WATCHERS} watchers": (asked.clients, WATCHERS)}
    rounds: dict[str, list[Pair]] = {kind: [] for kind in kinds}
    for number in range(asked.rounds):
        for kind, lookers in kinds.items():
            rounds[kind].append(paired(asked.robot, lookers, asked.seconds, console_first=number % 2 == 1))
    head = f"{'':17}{'p99':>8}{'latest':>12}{f'late of {ticks}':>14}{'more':>19}"
    print(f"{head}{'exhibition':>12}{'console':>9}{'a page':>12}")
    for kind, pairs in rounds.items():
        more = quartiles([one.having.late - one.without.late for one in pairs])
        for name, found in (("  without", [one.without for one in pairs]), (kind, [one.having for one in pairs])):
            one = Round(*map(statistics.median, zip(*found, strict=True)))
            ticks_told = f"{one.p99 * 1000:>8.1f} ms{one.latest * 1000:>8.1f} ms{one.late:>12.0f}"
            told = f"{round(more[1]):+d} ({round(more[0]):+d} to {round(more[2]):+d})" if name == kind else ""
            page = f"{one.page / 1000:>7.1f} kB/s" if name == kind else ""
            watcher = f", a watcher {one.watcher / 1000:.1f} kB/s" if one.watcher else ""
            cpu = f"{one.exhibition:>11.1%}" + (f"{one.console:>9.1%}" if name == kind else "")
            print(f"{name:17}{ticks_told}{told:>19} {cpu}{page}{watcher}")


def paired(robot: str, lookers: tuple[int, int], seconds: float, *, console_first: bool) -> Pair:
    """Run the tour once: a block without a console, and one with a console, with `lookers` pages and watchers."""
    folder = temporary_folder("lumen-console-")
    shutil.copy(ROOT / MAIN_FILE, folder)
    for name in (name for name in PROJECT_FOLDERS if (ROOT / name).is_dir()):
        shutil.copytree(ROOT / name, folder / name)
    found: dict[bool, Round] = {}
    try:
        project = lumen.load(folder)
        story = project.stories["visitor"]
        setup, directory = set_up(robot, project, "1", story), RunDirectory(folder)
        with Exhibition(Plan(project, setup, story=story, options={"directory": directory})) as exhibition:
            directory.open(exhibition.node.bus, "memory://", project)
            exhibition.start()
            for with_it in (console_first, not console_first):
                if with_it:
                    with console(folder) as (server, port), listeners(port, *lookers) as pages:
                        found[True] = measured(exhibition, seconds, server, pages)
                else:
                    found[False] = measured(exhibition, seconds, None, None)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return Pair(found[False], found[True])


def measured(exhibition: Exhibition, seconds: float, server: Guarded[str] | None, pages: Guarded[str] | None) -> Round:
    """Tick for `seconds` after `SETTLED` [s], or until the exhibition ends; return what was measured in that time."""
    late, began, before, counting, bytes_before = list[float](), time.monotonic(), 0.0, False, (0.0, 0.0)
    cpu = server_cpu = 0.0
    told = Told(pages) if pages else None
    while (now := time.monotonic()) - began < SETTLED + seconds and not exhibition.over:
        if not counting and now - began >= SETTLED:
            counting, cpu, server_cpu = True, time.process_time(), cpu_of(server)
            bytes_before = told.bytes if told else (0.0, 0.0)
            before = now
        exhibition.tick()
        if counting:
            after = time.monotonic()
            late.append(after - before - TICK_PERIOD)
            before = after
    took = time.monotonic() - began - SETTLED
    page, watcher = told.bytes if told else (0.0, 0.0)
    late.sort()
    return Round(
        late[int(0.99 * len(late))], late[-1], sum(one > TICK_PERIOD for one in late),
        (time.process_time() - cpu) / took, (cpu_of(server) - server_cpu) / took,
        (page - bytes_before[0]) / took, (watcher - bytes_before[1]) / took,
    )  # fmt: skip


class Told:
    """The bytes that each page and watcher has read so far, as reported by the listening process."""

    def __init__(self, process: Guarded[str]) -> None:
        self.bytes = (0.0, 0.0)
        self._process = process
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout
        with suppress(ValueError):  # closed during a read: the block is over
            for line in self._process.stdout:
                page, watcher = json.loads(line)
                self.bytes = page, watcher


def cpu_of(process: Guarded[str] | None) -> float:
    """Return the CPU time of a process so far [s]."""
    if process is None:
        return 0.0
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_SECOND


@contextmanager
def console(folder: Path) -> Iterator[tuple[Guarded[str], int]]:
    """Yield a console's process and its port."""
    line = [sys.executable, "-m", "lumen", "console", folder, "--port", "0"]
    with Guarded(line, stdin=DEVNULL, stdout=PIPE, text=True) as process:
        try:
            assert process.stdout
            address = process.stdout.readline().split("http://")[1].split("/")[0]
            yield process, int(address.rpartition(":")[2])
        finally:
            process.kill()


@contextmanager
def listeners(port: int, pages: int, watchers: int) -> Iterator[Guarded[str]]:
    """Yield a process with that many pages and watchers."""
    line = [sys.executable, __file__, "--listen", port, pages, watchers]
    with Guarded(line, stdin=DEVNULL, stdout=PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def listen(port: int, pages: int, watchers: int) -> None:
    """Act as that many pages, of which the last of several never reads; print the bytes read ten times per second."""
    counts = {"/api/events": 0, "/camera/NAO": 0}

    def look(path: str, *, reads: bool = True) -> None:
        while True:
            with socket.create_connection(("127.0.0.1", port)) as wire:
                wire.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
                while reads and (read := wire.recv(1 << 16)):
                    counts[path] += len(read)
                if not reads:
                    threading.Event().wait()
            threading.Event().wait(0.5)  # a camera without an image ends its answer

    reading = max(1, pages - 1) if pages else 0
    ways = ["/api/events"] * reading + ["/camera/NAO"] * watchers
    threads = [threading.Thread(target=look, args=(path,), daemon=True) for path in ways]
    if pages > 1:
        threads.append(threading.Thread(target=look, args=("/api/events",), kwargs={"reads": False}, daemon=True))
    for thread in threads:
        thread.start()
    while True:
        print(
            json.dumps([counts["/api/events"] / max(1, reading), counts["/camera/NAO"] / max(1, watchers)]), flush=True
        )
        threading.Event().wait(0.1)


if __name__ == "__main__":
    main()
