"""Measure skills: the time from a command to the first line of code, idle and misbehaving ones, and lint.

    python benchmarks/skills.py [--calls N]

Each figure is printed with its limit. Times of a tick are processor times of the thread that ticks the robot, the
others wall times.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median, quantiles

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.features.skills.changing import project_in
from tests.features.skills.stage import Stage, stage

from lumen.language.commands import Stop
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.memoization import _last as memoized
from lumen.upkeep.garbage import gc_paused

TEN = 10
PATIENCE = 30.0
"""The timeout of a measurement [s]."""
HEAD = "import os, subprocess, sys, time\nfrom lumen.skills import skill\n\n@skill\ndef {name}(call):\n"
MISBEHAVIOURS = (
    "while True: pass",
    "time.sleep(600)",
    "while True: print('x' * 1000)",
    "while True: call.progress(0.5)",
    "while True: subprocess.Popen(['sleep', '600']).pid; time.sleep(0.1)",
    "os.dup2(os.open('/dev/null', 0), 0); time.sleep(600)",
    "os.closerange(3, 30); time.sleep(600)",
    "x = [bytearray(1_000_000) for _ in range(10_000)]; time.sleep(600)",
    "while True: call.say('x')",
    "import signal; [signal.signal(n, signal.SIG_IGN) for n in (1, 2, 15)]; time.sleep(600)",
)


def main() -> None:
    parser = argparse.ArgumentParser(description="What skills cost.")
    parser.add_argument("--calls", type=int, default=200, help="the calls of each measurement (default: 200)")
    calls = parser.parse_args().calls
    with _acting({"act": "print('here')"}) as made:
        _show("warm: command to first line, median", 1e3 * median(_first_lines(made, calls)), "ms", 5.0)
        _show("warm: 95th percentile", 1e3 * quantiles(_first_lines(made, calls), n=20)[-1], "ms")
        _show("idle: processor time in 5 s", _idle(made), "s", 0.0)
        _show("cold: command to first line, median", 1e3 * median(_cold(made, max(calls // 10, 3))), "ms")
    bodies = {f"bad{i}": body for i, body in enumerate(MISBEHAVIOURS)}
    with _acting(bodies) as made:
        starting, stopping, ended = _misbehaving(made)
        _show("a tick that starts ten", 1e3 * starting, "ms", 2.0)
        _show("a tick that cancels and ends ten misbehaving skills", 1e3 * stopping, "ms", 2.0)
        _show("from the stop until the robot is free of them", 1e3 * ended, "ms")
        _show("a tick in which ten are reaped, the worst", 1e3 * _reaped(made), "ms", 2.0)
    _show("lint, for each skill", 1e3 * _lint(100), "ms", 1.0)


@contextmanager
def _acting(bodies: dict[str, str]) -> Iterator[Stage]:
    """Yield a project with a skill for each of these bodies."""
    changes = {f"skills/{name}.yaml": ("", f"performed-by: {{python: skills/{name}.py}}\n") for name in bodies}
    changes |= {f"skills/{name}.py": ("", HEAD.format(name=name) + f"    {body}\n") for name, body in bodies.items()}
    with tempfile.TemporaryDirectory() as folder, stage(project_in(Path(folder) / "hall", changes)) as made:
        yield made


def _first_lines(made: Stage, calls: int) -> list[float]:
    """Return the times from a command to the first line that its code prints [s]."""
    made.perform("act")
    found = []
    for _ in range(calls):
        time.sleep(0.03)  # only the first forty lines per second are shown
        found.append(_first_line(made))
    return found


def _cold(made: Stage, calls: int) -> list[float]:
    """Return the times of `_first_lines` if each call starts a program [s]."""
    found = []
    for _ in range(calls):
        for process in made.workshop.processes("act"):
            process.kill()
        found.append(_first_line(made))
    return found


def _first_line(made: Stage) -> float:
    made.told.clear()
    began = time.perf_counter()
    id = made.start("act")
    while not made.told and time.perf_counter() - began < PATIENCE:
        time.sleep(0.0001)
    taken = time.perf_counter() - began
    made.end(id)
    return taken


def _idle(made: Stage) -> float:
    """Return the processor time of an idle skill's program in 5 s [s]."""
    (process,) = made.workshop.processes("act")
    stat = Path(f"/proc/{process.pid}/stat")

    def used() -> int:
        fields = stat.read_text().rpartition(")")[2].split()
        return int(fields[11]) + int(fields[12])

    before = used()
    time.sleep(5.0)
    return (used() - before) / 100


def _misbehaving(made: Stage) -> tuple[float, float, float]:
    """Return the processor time of the ticks that start and stop ten skills, and the duration of the stop [s]."""
    ids = [f"d{i}" for i in range(TEN)]
    for i in range(TEN):
        made.executor.start(ids[i], made.command(f"bad{i}"))
    starting = _tick(made)
    deadline = time.monotonic() + 3.0
    while time.monotonic() < deadline:
        made.tick()
        time.sleep(0.02)
    began = time.perf_counter()
    made.executor.start("stop", Stop())
    stopping = _tick(made)
    while not all(id in made.events for id in ids) and time.perf_counter() - began < PATIENCE:
        made.tick()
    return starting, stopping, time.perf_counter() - began


def _reaped(made: Stage) -> float:
    """Return the processor time of the most expensive tick while the programs are killed and reaped [s]."""
    worst, deadline = 0.0, time.monotonic() + 2.0
    while time.monotonic() < deadline:
        worst = max(worst, _tick(made))
        time.sleep(0.02)
    return worst


def _tick(made: Stage) -> float:
    began = time.thread_time()
    made.tick()
    return time.thread_time() - began


def _lint(skills: int) -> float:
    """Return the additional time of lint for each skill of a project [s]."""
    with tempfile.TemporaryDirectory() as folder:
        root = project_in(Path(folder) / "hall")
        few = _linted(root)
        for i in range(skills):
            text = (root / "skills/spray.yaml").read_text("utf-8").replace("spray.py", f"spray{i}.py")
            (root / f"skills/spray{i}.yaml").write_text(text, "utf-8")
            code = (root / "skills/spray.py").read_text("utf-8").replace("def spray", f"def spray{i}")
            (root / f"skills/spray{i}.py").write_text(code, "utf-8")
        return (_linted(root) - few) / skills


def _linted(root: Path) -> float:
    files, found = read_files(root), []
    for _ in range(5):
        memoized.clear()
        with gc_paused():  # as in `lumen lint`
            began = time.process_time()
            check_files(root, files)
            found.append(time.process_time() - began)
    return min(found)


def _show(what: str, value: float, unit: str, limit: float | None = None) -> None:
    kept = "" if limit is None else f"   (limit {limit:g} {unit}: {'kept' if value <= limit else 'NOT KEPT'})"
    print(f"{what:55} {value:8.3f} {unit}{kept}")


if __name__ == "__main__":
    main()
