"""What a console costs: the latest tick of the exhibition, CPU time of both, and bytes for each page.

    python benchmarks/console.py [--robot simulation|recording] [--clients 50] [--seconds S] [--rounds N]

The shipped tour with its visitor in real time; the console and the pages that listen are processes of their own. One of
the pages never reads. A tick is late by as much as it comes after its 50th of a second: told are the 99th of a hundred
and the latest, and how many came a whole period late, which a machine without a console has, too, where it is crowded:
compare with the first row. Watchers look at the camera, as pages do that show what the robot sees.
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
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import DEVNULL, PIPE, Guarded, temporary_folder

import lumen
from lumen.app.exhibition import Exhibition
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.setup import set_up
from lumen.loading.files import PROJECT_FOLDERS
from lumen.loading.packaged import MAIN_FILE
from lumen.runtime.loop import TICK_PERIOD

ROOT = Path(__file__).parents[1]
SETTLED = 3.0
"""After which is measured [s]."""
TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
WATCHERS = 5


class Round(NamedTuple):
    """Ticks [s] and how many were late, CPU time of a second [s] of exhibition and console, bytes a second of each."""

    p99: float
    latest: float
    late: float
    exhibition: float
    console: float
    page: float
    watcher: float


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", choices=("recording", "simulation"), default="simulation")
    parser.add_argument("--clients", type=int, default=50, help="pages that listen, of which one never reads")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--listen", nargs=3, metavar=("PORT", "PAGES", "WATCHERS"), help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.listen:
        listen(*map(int, asked.listen))
        return
    print(
        f"{platform.machine()}, {os.cpu_count()} cores, CPython {platform.python_version()}, the {asked.robot} robot,"
    )
    print(f"{asked.rounds} rounds of {asked.seconds:g} s, medians\n")
    kinds = {"no console": None, "nobody looks": (0, 0), "1 page": (1, 0), f"{asked.clients} pages": (asked.clients, 0)}
    if asked.robot == "simulation":
        kinds |= {f"and {WATCHERS} watchers": (asked.clients, WATCHERS)}
    rounds: dict[str, list[Round]] = {kind: [] for kind in kinds}
    for _ in range(asked.rounds):
        for kind, lookers in kinds.items():
            rounds[kind].append(live(asked.robot, lookers, asked.seconds))
    columns = (
        f"{'tick p99':>11}{'latest':>11}{'late':>6}  {'exhibition':>11}{'console':>9}{'a page':>11}{'a watcher':>12}"
    )
    print(" " * 16 + columns)
    for kind, found in rounds.items():
        one = Round(*map(statistics.median, zip(*found, strict=True)))
        ticks = f"{one.p99 * 1000:>8.1f} ms{one.latest * 1000:>8.1f} ms{one.late:>6.0f}"
        cpu = f"{one.exhibition:>11.1%}{one.console:>9.1%}"
        print(f"{kind:16}{ticks}  {cpu}{one.page / 1000:>6.1f} kB/s{one.watcher / 1000:>7.1f} kB/s")


def live(robot: str, lookers: tuple[int, int] | None, seconds: float) -> Round:
    """One run of the tour, with so many pages and watchers, None without a console."""
    folder = temporary_folder("lumen-console-")
    shutil.copy(ROOT / MAIN_FILE, folder)
    for name in PROJECT_FOLDERS:
        shutil.copytree(ROOT / name, folder / name)
    try:
        project = lumen.load(folder)
        story = project.stories["visitor"]
        setup, directory = set_up(robot, project, "1", story), RunDirectory(folder)
        with Exhibition(project, setup, story=story, run_directory=directory) as exhibition:
            directory.open(exhibition.node.bus, "memory://", project)
            exhibition.start()
            if lookers is None:
                return measured(exhibition, seconds, None, None)
            with console(folder) as (server, port), listeners(port, *lookers) as pages:
                return measured(exhibition, seconds, server, pages)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def measured(exhibition: Exhibition, seconds: float, server: Guarded[str] | None, pages: Guarded[str] | None) -> Round:
    """Tick, and measure from `SETTLED` on."""
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
    """What the listening process says that each of its pages and watchers has read so far [bytes]."""

    def __init__(self, process: Guarded[str]) -> None:
        self.bytes = (0.0, 0.0)
        self._process = process
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            page, watcher = json.loads(line)
            self.bytes = page, watcher


def cpu_of(process: Guarded[str] | None) -> float:
    """CPU time of a process so far [s]."""
    if process is None:
        return 0.0
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_SECOND


@contextmanager
def console(folder: Path) -> Iterator[tuple[Guarded[str], int]]:
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
    line = [sys.executable, __file__, "--listen", port, pages, watchers]
    with Guarded(line, stdin=DEVNULL, stdout=PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def listen(port: int, pages: int, watchers: int) -> None:
    """Be so many pages, of which the last of several never reads; say ten times a second how much each has read."""
    counts = {"/api/events": 0, "/camera/NAO": 0}

    def look(path: str, *, reads: bool = True) -> None:
        while True:
            with socket.create_connection(("127.0.0.1", port)) as wire:
                wire.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
                while reads and (read := wire.recv(1 << 16)):
                    counts[path] += len(read)
                if not reads:
                    threading.Event().wait()
            threading.Event().wait(0.5)  # a camera that shows nothing yet ends its answer

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
