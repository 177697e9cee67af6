"""Runs tests many times, quiet, crowded and slow, in random order, and lists each that ever failed.

    python scripts/shaken.py --suite test                 8 runs quiet, 8 crowded, 4 on half a core
    python scripts/shaken.py --suite all --quiet 2 --crowded 2 --half 2
    python scripts/shaken.py --suite test --only-real     real things: 30 runs on half a core
    python scripts/shaken.py --half 5 --seed 17 -- tests/buses any words for pytest

Crowded means four busy loops beside the tests, which have the weight of one process for each worker. Half a core is a
cgroup's quota, if this user may make one; else the first core alone, shared with a busy loop. `--only-real` takes the
tests with a process, a broker or a browser. The run numbered i has the seed plus i; what a run printed is kept in
`.cache/shaken`, and beside it each test's outcome as soon as it is known, with the traceback. The exit code is 1 if
anything failed.
All processes that it starts end with it, also on Ctrl-C.
"""

import argparse
import json
import os
import random
import resource
import shutil
import signal
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.guarded import STDOUT, Guarded  # noqa: E402

LOGS = ROOT / ".cache" / "shaken"
CGROUPS = Path("/sys/fs/cgroup")
BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent:\n    for _ in range(1_000_000): pass"
"""A loop that keeps a core busy until its parent is gone."""
CROWD = 4
"""The busy loops of a crowded machine."""
PERIOD, QUOTA = 100_000, 50_000
"""Half a core: this many microseconds of each period."""
ENDING = 60.0
"""The time for an interrupted pytest to end its fixtures, before it is killed [s]."""
LINGERING = 60.0
"""The time that processes of tests have to end by themselves after pytest [s]."""
USUAL = {"quiet": 8, "crowded": 8, "half": 4}
REAL = {"quiet": 0, "crowded": 0, "half": 30}
ENTER = 'for group in $GROUPS_ENTERED; do echo $$ > "$group/cgroup.procs"; done; exec "$@"'


class Group:
    """Control groups that contain all processes of a run: they count its processor time, and may limit it."""

    def __init__(self, name: str) -> None:
        self.folders: list[Path] = []
        for line in Path("/proc/self/cgroup").read_text("utf-8").splitlines():
            _, controllers, path = line.split(":", 2)
            mounted = [CGROUPS] if not controllers else [CGROUPS / one for one in controllers.split(",")]
            for mount in {folder.resolve() for folder in mounted if folder.name in ("cgroup", "cpu", "cpuacct")}:
                if not (mount / "cgroup.procs").exists():
                    continue  # a folder that only contains the groups of version 1
                with suppress(OSError):
                    (folder := mount / path.strip("/") / name).mkdir()
                    self.folders.append(folder)

    def limit(self) -> bool:
        """Set the quota to half a core; return True if the system permits it."""
        return self._write({"cpu.max": f"{QUOTA} {PERIOD}", "cpu.cfs_quota_us": str(QUOTA)})

    def weigh(self, processes: int) -> None:
        """Give the group the weight of this many processes; else all its processes together count as one."""
        self._write({"cpu.weight": str(100 * processes), "cpu.shares": str(1024 * processes)})

    def _write(self, settings: Mapping[str, str]) -> bool:
        """Write the first of these settings that the system has, and return True; False if it permits none."""
        for folder in self.folders:
            for file, value in settings.items():
                with suppress(OSError):
                    if (folder / file).exists():
                        (folder / file).write_text(value)
                        return True
        return False

    def cpu_time(self) -> float | None:
        """Return the processor time of all processes of the group [s]; None if the system does not count it."""
        for folder in self.folders:
            with suppress(OSError, ValueError, KeyError):
                if (usage := folder / "cpuacct.usage").exists():
                    return int(usage.read_text()) / 1e9
                counts = dict(line.split() for line in (folder / "cpu.stat").read_text().splitlines())
                return int(counts["usage_usec"]) / 1e6
        return None

    def pids(self) -> set[int]:
        """Return the ids of the processes in the groups."""
        found: set[int] = set()
        for folder in self.folders:
            with suppress(OSError):
                found.update(map(int, (folder / "cgroup.procs").read_text().split()))
        return found

    def close(self) -> int:
        """Kill the processes that do not end by themselves, remove the groups, and return the number of killed ones."""
        deadline = time.monotonic() + LINGERING
        while self.pids() and time.monotonic() < deadline:
            time.sleep(0.05)
        left = self.pids()
        deadline = time.monotonic() + ENDING
        while (pids := self.pids()) and time.monotonic() < deadline:
            for pid in pids:
                with suppress(ProcessLookupError, PermissionError):
                    os.kill(pid, signal.SIGKILL)
            time.sleep(0.05)
        for folder in self.folders:
            with suppress(OSError):
                folder.rmdir()
        return len(left)


@dataclass(frozen=True)
class Run:
    """The results of one run of the tests."""

    condition: str
    seed: int
    passed: int
    failed: frozenset[str]
    wall: float
    """Wall time [s]."""
    cpu: float
    """Processor time [s]."""
    left: int
    """The number of processes left behind."""
    log: Path


class Plan(NamedTuple):
    """A planned run: `number` counts the runs of its condition from 1 to `of`."""

    condition: str
    number: int
    of: int
    seed: int


def main(words: Sequence[str] | None = None) -> int:
    arguments = parsed(sys.argv[1:] if words is None else words)
    counts = {name: getattr(arguments, name) for name in USUAL}
    plans = planned({name: usual(arguments)[name] if n is None else n for name, n in counts.items()}, arguments.seed)
    LOGS.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # end in order, as after Ctrl-C
    print(
        f"{len(plans)} runs, the first with --seed {arguments.seed}: {' '.join(selection(arguments)) or 'all'}",
        flush=True,
    )
    runs: list[Run] = []
    try:
        for plan in plans:
            runs.append(run := shaken(plan, arguments))
            print(f"{plan.condition} {plan.number} of {plan.of}, {told(run)}", flush=True)
    except KeyboardInterrupt:
        plan = plans[len(runs)]
        passed, failed = read(log_of(plan).with_suffix(".jsonl"))
        print(f"interrupted in {plan.condition} {plan.number} of {plan.of}: all that was started has been ended")
        print("\n".join((f"seed {plan.seed}: {passed} passed, {len(failed)} failed until then", *sorted(failed))))
    if runs:
        print("\n".join(summary(runs)), flush=True)
    return int(len(runs) < len(plans) or any(run.failed for run in runs))


def parsed(words: Sequence[str]) -> argparse.Namespace:
    """Return the parsed command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in USUAL:
        parser.add_argument(f"--{name}", type=int, metavar="N", help=f"runs of this kind ({USUAL[name]})")
    parser.add_argument("--suite", choices=("test", "rest", "all"), help="the tests that a make target runs")
    parser.add_argument("--only-real", action="store_true", help="only tests with a process, a broker or a browser")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1_000_000), metavar="N")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, metavar="N", help="pytest's (one a core)")
    parser.add_argument("words", nargs="*", metavar="-- …", help="more words for pytest")
    return parser.parse_args(words)


def usual(arguments: argparse.Namespace) -> dict[str, int]:
    """Return the default numbers of runs of each kind: 0 for kinds not named, if the command line names others."""
    if any(getattr(arguments, name) is not None for name in USUAL):
        return dict.fromkeys(USUAL, 0)
    return REAL if arguments.only_real else USUAL


def planned(counts: dict[str, int], seed: int) -> list[Plan]:
    """Return the runs to be made, each with a seed of its own."""
    each = [(name, n + 1, count) for name, count in counts.items() for n in range(count)]
    return [Plan(*one, seed + at) for at, one in enumerate(each)]


def selection(arguments: argparse.Namespace) -> list[str]:
    """Return the words by which pytest selects tests."""
    words = ["--suite", arguments.suite] if arguments.suite else []
    return [*words, *(["--only-real"] if arguments.only_real else []), *arguments.words]


def shaken(plan: Plan, arguments: argparse.Namespace) -> Run:
    """Run the tests once, and end all processes that are left."""
    log = log_of(plan)
    outcomes = log.with_suffix(".jsonl")
    outcomes.write_text("")
    command: list[object] = [
        "sh",
        ROOT / "scripts/with_packages.sh",
        sys.executable,
        "-m",
        "pytest",
        "-n",
        arguments.workers,
        "--dist",
        "loadgroup",
    ]
    command += ["--no-loadscope-reorder", "-p", "tests.shuffled", "--order-seed", plan.seed, "--outcomes", outcomes]
    command += ["-m", "not soak", *selection(arguments)]
    with ExitStack() as stack, log.open("w") as told:
        group = Group(f"shaken-{os.getpid()}-{plan.seed}")
        stack.callback(group.close)
        group.weigh(arguments.workers)
        if plan.condition == "crowded":
            for _ in range(CROWD):
                stack.enter_context(busy())
        elif plan.condition == "half" and not group.limit():
            command = pinned(command)
            stack.enter_context(busy(alone=True))
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        code = finished(command, group, told)
        wall, after = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = group.cpu_time()
        if cpu is None:
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        left = group.close()
    passed, failed = read(outcomes)
    if code not in (0, 1) or (code == 1 and not failed):
        failed |= {f"the run itself ({meaning(code)})"}
    return Run(plan.condition, plan.seed, passed, frozenset(failed), wall, cpu, left, log)


def meaning(code: int) -> str:
    """Return the meaning of an exit code of pytest, such as `no tests collected`."""
    codes = {each.value: each.name.lower().replace("_", " ") for each in pytest.ExitCode}
    return codes.get(code, f"exit code {code}")


def log_of(plan: Plan) -> Path:
    """Return the file that gets what a run prints; the outcome of each test is in the file with `.jsonl`."""
    return LOGS / f"{plan.condition}-{plan.seed}.log"


def finished(command: Sequence[object], group: Group, told: object) -> int:
    """Run the command in the group, and return its exit code; on Ctrl-C it may end its fixtures first."""
    environment = {**os.environ, "GROUPS_ENTERED": " ".join(map(str, group.folders))}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as in the Makefile: else each process compiles everything again
    words = ["sh", "-c", ENTER, "sh", *command]
    process: Guarded[bytes] = Guarded(words, stdout=told, stderr=STDOUT, cwd=ROOT, env=environment)
    try:
        return process.wait()
    except BaseException:
        process.send_signal(signal.SIGINT)
        with suppress(Exception):
            process.wait(ENDING)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        raise


@contextmanager
def busy(*, alone: bool = False) -> Iterator[None]:
    """Run a busy loop, on the first core alone if requested."""
    command: list[object] = [sys.executable, "-c", BUSY]
    process: Guarded[bytes] = Guarded(pinned(command) if alone else command)
    try:
        yield
    finally:
        process.kill()
        process.wait()


def pinned(command: list[object]) -> list[object]:
    """Return the command, pinned to the first core. Raises SystemExit without taskset."""
    if shutil.which("taskset") is None:
        raise SystemExit(
            "half a core needs a writable cgroup with a quota of processor time, or taskset: neither is here"
        )
    return ["taskset", "-c", "0", *command]


def read(outcomes: Path) -> tuple[int, set[str]]:
    """Return the number of tests that passed, and those that failed; skip a line that a kill has cut."""
    passed, failed = 0, set[str]()
    for line in outcomes.read_text("utf-8").splitlines() if outcomes.exists() else ():
        with suppress(ValueError):
            test, outcome, *_ = json.loads(line)
            if outcome == "passed":
                passed += 1
            elif outcome == "failed":
                failed.add(test)
    return passed, failed


def told(run: Run) -> str:
    """Return the result of a run as text."""
    left = f", {run.left} processes left behind" if run.left else ""
    outcome = f"{run.passed} passed, {len(run.failed)} failed{left}"
    where = f"; see {run.log.relative_to(ROOT)}" if run.failed else ""
    return f"seed {run.seed}: {outcome}; {run.wall:.0f} s, {run.cpu:.0f} s of processor time{where}"


def summary(runs: Sequence[Run]) -> list[str]:
    """Return lines for each failed test: in how many runs of which kind, and with which seeds; the worst first."""
    tests = {test for run in runs for test in run.failed}
    lines = []
    for test in sorted(tests, key=lambda test: (-sum(test in run.failed for run in runs), test)):
        lines.append(test)
        for condition in dict.fromkeys(run.condition for run in runs):
            of = [run for run in runs if run.condition == condition]
            seeds = [str(run.seed) for run in of if test in run.failed]
            if seeds:
                lines.append(f"    {condition}: {len(seeds)} of {len(of)} runs, seeds {', '.join(seeds)}")
    return lines or [f"no test failed in {len(runs)} runs"]


if __name__ == "__main__":
    sys.exit(main())
