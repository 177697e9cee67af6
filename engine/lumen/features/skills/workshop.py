"""A robot's workshop: the processes of its skills, lent to successive calls, and restarted if they end."""

import hashlib
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import lumen
from lumen.errors import RobotFailedError, RobotRefusedError
from lumen.feature import VerbRow
from lumen.features.skills.manifest import Skill
from lumen.features.skills.module_call import ModuleAnswers, ModuleCall
from lumen.features.skills.process import SkillProcess
from lumen.features.skills.python_file import syntax_fault
from lumen.language.iso_time import iso_time
from lumen.language.projects import Project
from lumen.ports import Bus, SkillCall
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

MAX_PROCESSES = 4
"""The maximum number of simultaneous calls of a skill's program."""
FIRST_PAUSE, LONGEST_PAUSE = 0.5, 30.0
"""The first and the longest pause before a crashed program is started again [s]."""
LOADING = 20.0
"""The time limit for loading a skill's code [s]."""
MAX_CODE_BYTES = 4_000_000
MAX_TROUBLE = 200
"""The maximum length of a trouble in the skills' states [characters]."""
RUNNING, READY, PAUSED, IDLE = "running", "ready", "paused", "idle"
"""The states of a skill: a call is in progress; a program is ready; a crash requires a pause; no program runs."""

_CHILD = "import sys; sys.path.append({engine!r}); from lumen.skills import serve; serve()"
_ENGINE = str(Path(lumen.__file__).parents[1])


class _Code(NamedTuple):
    """A program's code, as read from its files."""

    stamp: tuple[tuple[str, int, int], ...]
    """The path, time of change [ns] and size [bytes] of each file."""
    hash: str
    """The SHA-256 hash of the skill's target and its files."""
    source: str = ""
    """The text of a Python file; empty for other programs."""


@dataclass
class _Bench:
    """The processes and the state of a skill."""

    row: VerbRow
    code: _Code | None = None
    """The code that calls use; None before a program was needed."""
    seen: _Code | None = None
    """The code that was read while `code` was None."""
    refused: tuple[tuple[str, int, int], ...] | None = None
    """The stamp of the newest code if it has a syntax error, else None."""
    fault: str = ""
    """The place and the message of that error."""
    idle: list[SkillProcess] = field(default_factory=list)
    """The processes that perform no call."""
    busy: list[SkillProcess] = field(default_factory=list)
    """The processes that perform calls."""
    backoff: Backoff = field(default_factory=lambda: Backoff(FIRST_PAUSE, LONGEST_PAUSE))
    again: float = 0.0
    remote: int = 0
    """The number of calls that a module is performing."""
    crashes: int = 0
    """The number of times that a program ended by itself or was killed."""
    trouble: str = ""
    """Why the last call failed, or its program was killed; empty after a successful call."""
    since: float = field(default_factory=time.time)
    """When the skill's state last changed [s since 1970]."""
    state: str = ""

    def now(self) -> str:
        """Return the current state, and update `since` if it has changed."""
        if self.busy or self.remote:
            state = RUNNING
        elif any(one.alive for one in self.idle):
            state = READY
        elif self.again > time.monotonic():
            state = PAUSED
        else:
            state = IDLE
        if state != self.state:
            self.state, self.since = state, time.time()
        return state

    @property
    def skill(self) -> Skill:
        assert isinstance(self.row.details, Skill)
        return self.row.details


class Workshop:
    """Lends processes to the calls of a project's skills.

    `tell` prints a line about a skill; `report` prints a problem, which other processes and the console show as well.
    `failed` receives a skill and the reason why a call failed, on the call's thread.
    """

    def __init__(
        self,
        project: Project,
        bus: Bus,
        tell: Callable[[str, str], None],
        report: Callable[[str, str], None],
        failed: Callable[[str, str], None] = lambda skill, reason: None,
    ) -> None:
        self.project, self.bus, self.tell, self.report, self._failed = project, bus, tell, report, failed
        self._root = Path(project.root)
        self._answers = ModuleAnswers(project, bus)
        self._lock = threading.RLock()
        self._benches: dict[str, _Bench] = {}
        self._closed = False
        self.use(project)

    def use(self, project: Project) -> None:
        """Use the skills of this project from now on.

        Processes of removed skills are ended, and idle processes of changed skills are closed.
        """
        with self._lock:
            self.project = project
            gone = [self._benches.pop(name) for name in [*self._benches] if name not in project.verbs]
            for name, row in project.verbs.items():
                bench = self._benches.setdefault(name, _Bench(row))
                if bench.row.details != row.details:
                    self._retire(bench)
                bench.row = row
        for bench in gone:
            self._retire(bench)
            for process in bench.busy:
                process.kill("the skill was removed")

    def warm(self) -> None:
        """Start the programs of `warm` skills that have no process; report programs that can't be started."""
        for name, bench in list(self._benches.items()):
            if (
                bench.skill.warm
                and bench.skill.kind != "module"
                and not (bench.idle or bench.busy or bench.again > time.monotonic())
            ):
                try:
                    self._refresh(name, bench)
                    process = self._started(name, bench)
                except RobotFailedError as error:
                    self.report(name, str(error))
                else:
                    with self._lock:
                        bench.idle.append(process)

    def look(self) -> None:
        """Use changed code, and start the programs of `warm` skills.

        If new code has a syntax error, the error is reported, and the old code stays in use.
        """
        for name, bench in list(self._benches.items()):
            if bench.code and bench.skill.kind != "module":
                self._refresh(name, bench)
            elif bench.skill.kind != "module" and (
                not bench.seen or bench.seen.stamp != _stamp(self._root, bench.skill)
            ):
                bench.seen = _read(self._root, bench.skill)
        self.warm()

    @property
    def hashes(self) -> dict[str, str]:
        """The hash of each skill's current code; skills whose code has not been read are left out."""
        with self._lock:
            found = {name: bench.code or bench.seen for name, bench in self._benches.items()}
        return {name: code.hash for name, code in found.items() if code}

    @property
    def states(self) -> dict[str, dict[str, Any]]:
        """Each skill's state as JSON data, with the time of its last change, the last trouble and number of crashes."""
        with self._lock:
            return {
                name: {
                    "state": bench.now(),
                    "since": iso_time(bench.since),
                    "crashes": bench.crashes,
                    "trouble": bench.trouble,
                }
                for name, bench in self._benches.items()
            }

    def processes(self, name: str) -> list[SkillProcess]:
        """Return the processes of a skill that have not ended; none if there is no such skill."""
        with self._lock:
            bench = self._benches.get(name)
            return [one for one in (*bench.idle, *bench.busy) if one.alive] if bench else []

    def is_busy(self, name: str) -> bool:
        """Return whether a process performs a call of a skill; calls of modules do not count."""
        return name in self._benches and bool(self._benches[name].busy)

    @contextmanager
    def lent(self, call: SkillCall) -> Iterator[SkillProcess | ModuleCall]:
        """Lend a process, or a module, to a call.

        Afterwards the process is kept for the next call, unless its code is outdated or another process is idle.

        Raises RobotError if the skill was removed, has too many calls, or has a program that can't be started, or if
        the call is cancelled during the pause after a crash.
        """
        name = call.skill
        with self._lock:
            if (bench := self._benches.get(name)) is None or self._closed:
                raise RobotRefusedError(f"the project has no skill `{name}` any more")
            if len(bench.busy) >= MAX_PROCESSES:
                raise RobotRefusedError(f"{MAX_PROCESSES} calls of `{name}` are under way already")
        match call.row.details:
            case Skill("module", (module,)):
                with self._counted(name), closing(ModuleCall(self.project, self.bus, module, self._answers)) as remote:
                    yield remote
                return
        self._refresh(name, bench)
        self._pause(call, bench)
        with self._lock:
            process = next((one for one in bench.idle if one.alive), None)
            bench.idle = [one for one in bench.idle if one.alive and one is not process]
        process = process or self._started(name, bench)
        code = bench.code
        with self._lock:
            bench.busy.append(process)
        try:
            yield process
        finally:
            with self._lock:
                bench.busy.remove(process)
                keep = process.alive and not bench.idle and bench.code is code and not self._closed
                if keep and self._benches.get(name) is bench:
                    bench.idle.append(process)
                elif process.alive:
                    _in_background(process.close)

    @contextmanager
    def _counted(self, name: str) -> Iterator[None]:
        """Count a module's call in `remote` while it is under way."""
        with self._lock:
            bench = self._benches.get(name)
            if bench:
                bench.remote += 1
        try:
            yield
        finally:
            with self._lock:
                if bench:
                    bench.remote -= 1

    def failed(self, name: str, reason: str) -> None:
        """Record that a call of a skill failed, and why; pass both to the constructor's `failed`."""
        with self._lock:
            if bench := self._benches.get(name):
                bench.trouble = reason[:MAX_TROUBLE]
        self._failed(name, reason)

    def crashed(self, name: str, reason: str = "") -> None:
        """Count a program that ended by itself or was killed, and set the pause before the next start."""
        with self._lock:
            if bench := self._benches.get(name):
                bench.crashes += 1
                bench.trouble = reason[:MAX_TROUBLE] or bench.trouble
                bench.again = time.monotonic() + bench.backoff.next()

    def worked(self, name: str) -> None:
        """Record that a call succeeded: clear the trouble, and reset the pause to the shortest."""
        with self._lock:
            if bench := self._benches.get(name):
                bench.backoff.reset()
                bench.trouble = ""

    def close(self) -> None:
        """Kill all programs, and refuse further calls of programs."""
        with self._lock:
            self._closed = True
            processes = [one for bench in self._benches.values() for one in (*bench.idle, *bench.busy)]
            for bench in self._benches.values():
                bench.idle = []
        for process in processes:
            process.kill("the exhibition ended")
        self._answers.close()

    def _pause(self, call: SkillCall, bench: _Bench) -> None:
        """Wait until a crashed program can be started again. Raises RobotRefusedError if the call is cancelled."""
        left = bench.again - time.monotonic()
        if left > 0 and not any(one.alive for one in bench.idle):
            self.tell(call.skill, f"its program is started again in {left:.1f} s")
            while left > 0 and not call.cancelled:
                call.wait_for(lambda: False, within=left)
                left = bench.again - time.monotonic()
            if call.cancelled:
                raise RobotRefusedError(f"`{call.skill}` was cancelled")

    def _refresh(self, name: str, bench: _Bench) -> None:
        """Use the code that is on the disk now; report Python code with a syntax error, and keep the earlier code.

        Raises RobotFailedError if there is no earlier code.
        """
        skill = bench.skill
        stamp = _stamp(self._root, skill)
        if bench.code and stamp in (bench.refused, bench.code.stamp):
            return
        if stamp == bench.refused:
            raise RobotFailedError(bench.fault)
        code = _read(self._root, skill)
        if skill.kind == "python" and (fault := syntax_fault(code.source.encode(), skill.target[0])):
            bench.refused, bench.fault = stamp, f"{skill.target[0]}:{fault.line}:{fault.column} {fault.message}"
            self.report(name, bench.fault + ("; the code before stays in use" if bench.code else ""))
            if bench.code is None:
                raise RobotFailedError(bench.fault)
            return
        with self._lock:
            bench.refused = None
            changed, bench.code = bench.code is not None and bench.code.hash != code.hash, code
            if changed:
                bench.again = 0.0
                bench.backoff.reset()
                self._retire(bench)
        if changed:
            self.tell(name, f"uses its new code, {code.hash[:12]}")

    def _retire(self, bench: _Bench) -> None:
        """Close the idle processes, in the background."""
        retired, bench.idle = bench.idle, []
        for process in retired:
            _in_background(process.close)

    def _started(self, name: str, bench: _Bench) -> SkillProcess:
        """Start a program; return its process. Raises RobotFailedError if it does not start or load its code."""
        skill, code = bench.skill, bench.code
        if skill.kind == "command":
            return SkillProcess(name, skill.target, str(self._root), skill.memory, lambda line: self.tell(name, line))
        file = self._root / skill.target[0]
        if code is None or not code.source:
            raise RobotFailedError(f"there is no code for `{name}`: {skill.target[0]} is missing or empty")
        command = [sys.executable, "-c", _CHILD.format(engine=_ENGINE)]
        process = SkillProcess(name, command, str(self._root), skill.memory, lambda line: self.tell(name, line))
        loaded = threading.Event()
        process.expect(loaded.set)
        process.send({"load": code.source, "file": str(file)})
        loaded.wait(LOADING)
        match process.take():
            case [{"loaded": True}]:
                return process
            case [{"loaded": False, "error": str(reason)}, *_]:
                process.kill()
            case [{"ended": str(reason)}, *_]:
                pass
            case _:
                reason = f"its code took more than {LOADING:g} s to load"
                process.kill()
        self.crashed(name)
        raise RobotFailedError(f"`{name}` can't be loaded: {reason}")


def _in_background(work: Callable[[], None]) -> None:
    WatchedThread("lumen-skill-end", work).start()


def _files(root: Path, skill: Skill) -> list[Path]:
    """Return the files of a skill's program.

    For a Python file, these include all Python files in the same folder, which it can import. For a command, they are
    its words that name existing files.
    """
    if skill.kind == "python":
        own = root / skill.target[0]
        return sorted({own, *own.parent.glob("*.py")})
    return [path for word in skill.target if (path := root / word).is_file()]


def _stamp(root: Path, skill: Skill) -> tuple[tuple[str, int, int], ...]:
    found = []
    for path in _files(root, skill):
        with suppress(OSError):
            status = os.stat(path)
            found.append((str(path), status.st_mtime_ns, status.st_size))
    return tuple(found)


def _read(root: Path, skill: Skill) -> _Code:
    stamp, digest, source = _stamp(root, skill), hashlib.sha256(repr(skill.target).encode()), ""
    for path, *_ in stamp:
        with suppress(OSError):
            with open(path, "rb") as file:
                content = file.read(MAX_CODE_BYTES)
            digest.update(content)
            if skill.kind == "python" and path == str(root / skill.target[0]):
                source = content.decode("utf-8", "replace")
    return _Code(stamp, digest.hexdigest(), source)


_open: list[Workshop | Project] = []
"""The receivers of calls: workshops, and projects whose skills an exhibition deliberately only pretends."""


def register(taker: Workshop | Project) -> Callable[[], None]:
    """Let a workshop receive calls, or have a project's skills pretended, as in a story; return the undoing function.

    Undoing it twice does nothing more.
    """

    def undo() -> None:
        with suppress(ValueError):
            _open.remove(taker)

    _open.append(taker)
    return undo


def taker_of(skill: str, row: VerbRow) -> Workshop | Project | None:
    """Return what receives this skill's calls: a workshop, a project that pretends it, or None if neither is open.

    Of several exhibitions of one folder and robot, it is the one whose project has this row; else the newest, since a
    reload replaces the rows.
    """
    takers = [one for one in [*_open] if (_project(one).root, _project(one).robot) == (row.root, row.robot)]
    return next((one for one in takers if _project(one).verbs.get(skill) is row), takers[-1] if takers else None)


def _project(taker: Workshop | Project) -> Project:
    return taker.project if isinstance(taker, Workshop) else taker
