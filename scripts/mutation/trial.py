"""Run tests in a copy of the repository, with a limit on the processor time of all processes that they start.

    python -m mutation.trial JOB       # in a copy: watches over …
    python -m mutation.trial JOB run   # … pytest, which runs batch after batch until a test fails

The watching process adopts each process that loses its parent (`PR_SET_CHILD_SUBREAPER`), so none leaves the tree. The
processor time of a process is in /proc or, once it has ended, in the times of the process that waited for it.
"""

import ctypes
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
LINKED = (".git", ".cache")
LEFT_OUT = (*LINKED, ".venv", ".pytest_cache", ".mypy_cache", ".ruff_cache", ".import_linter_cache", "build", ".lumen")
PR_SET_CHILD_SUBREAPER = 36
LOOK = 0.5
"""The pause between two checks of the processes [s]."""
MEMORY = 6 << 30
"""The memory limit of one process [bytes]."""
PASSED = (0, 5)
"""Exit codes of pytest if no test failed, or none was left to run."""


class Ended(NamedTuple):
    """The end of a run of tests: "passed", "failed", or the limit that was reached.

    `test` is the first one that failed, or the one that was running; `own` is its processor time alone, `cpu` that of
    all [s].
    """

    how: str
    test: str
    own: float
    cpu: float
    failed: Sequence[str]


class Copy:
    """A copy of the repository, with a virtual environment whose `lumen` is the copy's engine."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.copytree(ROOT, folder, ignore=_left_out, symlinks=True)
        for linked in (ROOT / ".git", *(ROOT / ".cache").glob("*")):
            target = folder / linked.relative_to(ROOT)
            target.parent.mkdir(exist_ok=True)
            if linked.name not in ("xdg", "mutants"):
                target.symlink_to(linked)
        self._environment(folder / ".venv")
        self._changes = 0

    def _environment(self, new: Path) -> None:
        old = Path(sys.prefix)
        site = Path("lib", f"python{sys.version_info[0]}.{sys.version_info[1]}", "site-packages")
        (new / site).mkdir(parents=True)
        (new / "bin").mkdir()
        shutil.copy(old / "pyvenv.cfg", new)
        for file in (old / site).iterdir():
            (new / site / file.name).symlink_to(file)
        (new / site / "_lumen_robot.pth").unlink()
        (new / site / "_lumen_robot.pth").write_text(str(self.folder / "engine"))
        for file in (old / "bin").iterdir():
            if file.is_symlink():
                (new / "bin" / file.name).symlink_to(file.readlink())
            elif file.read_bytes().startswith(b"#!" + os.fsencode(old)):
                moved = file.read_bytes().replace(os.fsencode(old), os.fsencode(new), 1)
                (new / "bin" / file.name).write_bytes(moved)
                (new / "bin" / file.name).chmod(0o755)
            else:
                (new / "bin" / file.name).symlink_to(file)

    def run(
        self,
        batches: Sequence[Sequence[str]],
        cpu: float,
        idle: float,
        change: tuple[str, bytes] | None = None,
        *,
        every: bool = False,
    ) -> Ended:
        """Run batches of tests until one fails, or `every` test, with a changed file if a change is given."""
        shutil.rmtree(self.folder / ".cache/xdg", ignore_errors=True)
        job = self.folder / "job.json"
        job.write_text(json.dumps({"batches": batches, "cpu": cpu, "idle": idle, "every": every}))
        command = [self.folder / ".venv/bin/python", "-m", "mutation.trial", job]
        environment = {
            **os.environ,
            "PYTHONPATH": str(self.folder / "scripts"),
            "VIRTUAL_ENV": str(self.folder / ".venv"),
        }
        original = self.folder / change[0] if change else job
        kept, times = original.read_bytes(), original.stat()
        try:
            if change:
                original.write_bytes(change[1])
                self._changes += 1
                os.utime(original, (0, self._changes))  # each content has its own time, so no compiled file is reused
            done = subprocess.run(
                command, cwd=self.folder, env=environment, capture_output=True, text=True, check=False
            )
        finally:
            original.write_bytes(kept)
            os.utime(original, ns=(times.st_atime_ns, times.st_mtime_ns))
        if done.returncode:
            raise RuntimeError(f"the trial itself failed:\n{done.stdout}{done.stderr}")
        return Ended(*json.loads(done.stdout))


def _left_out(folder: str, names: list[str]) -> list[str]:
    return [name for name in names if name in LEFT_OUT] if Path(folder) == ROOT else []


def watch(job: Path) -> Ended:
    """Run the tests in a process of their own until they end or reach a limit; leave no process behind."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    limits = json.loads(job.read_text())
    progress = job.with_suffix(".progress")
    progress.write_text("")
    with job.with_suffix(".log").open("wb") as log:
        command = [sys.executable, "-m", "mutation.trial", job, "run"]
        tests = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
    seen, changed, began, test, how = "", time.monotonic(), 0.0, "", ""
    while not how:
        time.sleep(LOOK)
        tree = _descendants()
        cpu = _used(tree)
        if (text := progress.read_text()) != seen:
            seen, changed = text, time.monotonic()
            latest = seen.splitlines()[-1].removeprefix("FAILED ")
            began, test = (began, test) if latest == test else (cpu, latest)
        if tests.poll() is not None:
            how = "passed" if tests.returncode in PASSED else "failed"
        elif cpu > limits["cpu"]:
            how = "processor time"
        elif time.monotonic() - changed > limits["idle"]:
            how = "time"
        elif any(stat.memory > MEMORY for stat in tree.values()):
            how = "memory"
        _reap(tree, but=tests.pid)
    while tree := _descendants():
        for pid in tree:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(0.01)
        _reap(tree)
    failed = [line.removeprefix("FAILED ") for line in progress.read_text().splitlines() if line.startswith("FAILED ")]
    total = _used({})
    return Ended(how, failed[0] if failed else test, total - began, total, failed)


class Stat(NamedTuple):
    """A process: its parent, its processor time in clock ticks, and its resident memory [bytes]."""

    parent: int
    ticks: int
    memory: int


def _stat(pid: int) -> Stat:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return Stat(0, 0, 0)
    return Stat(int(fields[1]), sum(map(int, fields[11:15])), int(fields[21]) * os.sysconf("SC_PAGE_SIZE"))


def _descendants() -> dict[int, Stat]:
    """Return all processes that this one has started or adopted."""
    children: dict[int, dict[int, Stat]] = defaultdict(dict)
    for pid in [int(name) for name in os.listdir("/proc") if name.isdecimal()]:
        stat = _stat(pid)
        children[stat.parent][pid] = stat
    found: dict[int, Stat] = {}
    left = [os.getpid()]
    while left:
        below = children[left.pop()]
        found |= below
        left += below
    return found


def _used(tree: Mapping[int, Stat]) -> float:
    """Return the processor time of these processes and of those that have ended [s]."""
    return sum(stat.ticks for stat in tree.values()) / os.sysconf("SC_CLK_TCK") + sum(os.times()[2:4])


def _reap(tree: Mapping[int, Stat], but: int = 0) -> None:
    """Collect adopted processes that have ended."""
    for pid, stat in tree.items():
        if pid != but and stat.parent == os.getpid():
            with suppress(ChildProcessError):
                os.waitpid(pid, os.WNOHANG)


def run(job: Path) -> int:
    """Run pytest for each batch until a test fails; report each test in a file in the job's folder."""
    import pytest

    class Picked:
        """Run only some of the collected tests, in a given order, and report each."""

        def __init__(self, tests: Sequence[str]) -> None:
            self._rank = {test: rank for rank, test in enumerate(tests)}

        @pytest.hookimpl(trylast=True)
        def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
            chosen = [item for item in items if item.nodeid in self._rank]
            items[:] = sorted(chosen, key=lambda item: self._rank[item.nodeid])

        def pytest_runtest_logstart(self, nodeid: str) -> None:
            print(nodeid, file=progress, flush=True)

        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.failed:
                print(f"FAILED {report.nodeid}", file=progress, flush=True)

        def pytest_collectreport(self, report: pytest.CollectReport) -> None:
            if report.failed:
                print(f"FAILED {report.nodeid}", file=progress, flush=True)

    given, code = json.loads(job.read_text()), 0
    stop = () if given["every"] else ("-x",)
    with job.with_suffix(".progress").open("a") as progress:
        for batch in given["batches"]:
            files = [file for file in dict.fromkeys(test.partition("::")[0] for test in batch) if Path(file).exists()]
            if files:
                code = int(
                    pytest.main([*files, *stop, "--tb=short", "-p", "no:cacheprovider"], plugins=[Picked(batch)])
                )
            if code not in PASSED:
                return code
    return 0


if __name__ == "__main__":
    if sys.argv[2:] == ["run"]:
        sys.path[0] = os.getcwd()
        sys.exit(run(Path(sys.argv[1])))
    print(json.dumps(watch(Path(sys.argv[1]))))
