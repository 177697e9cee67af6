"""Starts that fail, or may: what is printed, who is told, the exit code, and what is in `.lumen/` afterwards.

Each mishap meets one robot or two, and the roles that differ: all of it, a robot, a brain, and a module, which may be a
guest in the folder of others; all roles if nothing is wrong. There is no broker: files that are well end with that.
Roles with the same outcome stand together. Times, ports, numbers of
processes and places are left out.
"""

import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from tests import ROOT
from tests.golden.exhibitions import TOLD, plain, small
from tests.golden.mishaps import MISHAPS
from tests.golden.served import HANG
from tests.golden.warm import Done, Warm, environment
from tests.guarded import DEVNULL, Guarded
from tests.waiting import until

SUITE = "rest"
NOWHERE = "amqp://guest:guest@127.0.0.1:1/"
"""An address without a broker: only root may listen on port 1."""
SHORT = ("--robot", "recording", "--speed", "max", "--for", "1s")
ROLES = ("robot", "brain", "motion", "visitor", "memory")
LINES = {
    "whole": (*SHORT, "--bus", "memory://"),
    **{role: ("--only", role, "--robot", "recording", "--bus", NOWHERE) for role in ROLES},
    "remote": ("--robot", "remote", "--bus", NOWHERE),
}
SOME = {1: ("whole", "robot", "brain", "memory"), 2: ("whole", "robot", "brain")}
ALONE = ("a story of no robot",)
"""Options that are tried with one robot only: two robots run on without an end."""
REFUSED: dict[str, tuple[str, ...]] = {
    "unknown robot": ("--robot", "nao"),
    "unknown name of a robot": ("--robot-name", "carl"),
    "no name of a robot": ("--robot-name", ","),
    "unknown part": (*SHORT, "--only", "brian"),
    "no part": ("--only", ","),
    "robot here and remote": ("--only", "robot", "--robot", "remote"),
    "parts on a bus of one process": ("--only", "brain", "--bus", "memory://"),
    "parts in time that flies": ("--only", "brain", "--bus", NOWHERE, "--speed", "max"),
    "a film of parts": ("--only", "robot", "--bus", NOWHERE, "--video", "film.mp4"),
    "the part robot of no robot": ("--only", "robot", "--robot", "none", "--bus", NOWHERE),
    "a film of no simulation": ("--robot", "recording", "--video", "film.mp4", "--bus", "memory://"),
    "unknown bus": ("--robot", "recording", "--bus", "kafka://127.0.0.1/"),
    "no bus": ("--robot", "recording", "--bus", "127.0.0.1"),
    "unknown story": ("--robot", "recording", "--story", "vistor"),
    "a story of no robot": ("--robot", "none", "--story", "visitor"),
    "unknown language": (*SHORT, "--language", "fr"),
    "no period": ("--robot", "recording", "--for", "soon"),
    "unknown speed": ("--robot", "recording", "--speed", "2"),
    "a real robot in time that flies": ("--robot", "naoqi", "--speed", "max"),
    "no robot in time that flies": ("--robot", "none", "--speed", "max"),
    "a story of a real robot": ("--robot", "naoqi", "--story", "visitor"),
    "an address of no real robot": ("--robot", "recording", "--robot-url", "tcp://127.0.0.1:1"),
    "nobody at a real robot's address": ("--robot", "naoqi", "--robot-url", "tcp://127.0.0.1:1"),
    "a broker that is not there": ("--robot", "recording", "--bus", NOWHERE),
}
"""Options that are refused, or that name something that does not exist."""


def record(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place, Warm(Path(place)) as warm:
        table = _Table(Path(place).resolve(), warm)
        for name in MISHAPS:
            _write(folder / f"{name}.txt", table.mishap(name))
        _write(folder / "options.txt", table.refused())
        _write(folder / "after-a-good-run.txt", table.after_a_good_run())
        _write(folder / "while-one-runs.txt", table.while_one_runs())


class _Table:
    def __init__(self, place: Path, warm: Warm) -> None:
        self._place, self._warm, self._count = place, warm, 0

    def mishap(self, name: str) -> Iterator[str]:
        """Yield the outcome of each role, for one robot and for two."""
        found: dict[str, list[str]] = {}
        for robots in (1, 2):
            for role in LINES if name == "nothing" else SOME[robots]:
                project = self._project(robots)
                MISHAPS[name](project)
                found.setdefault(self._outcome(project, LINES[role]), []).append(f"{_words(robots)}, {role}")
        for outcome, cases in found.items():
            yield f"# {'; '.join(cases)}\n\n{outcome}"

    def refused(self) -> Iterator[str]:
        """Yield the outcome of options that are refused."""
        for name, line in REFUSED.items():
            found: dict[str, list[str]] = {}
            for robots in (1,) if name in ALONE else (1, 2):
                found.setdefault(self._outcome(self._project(robots), line), []).append(_words(robots))
            for outcome, cases in found.items():
                yield f"# {name}; {'; '.join(cases)}\n\n{outcome}"

    def after_a_good_run(self) -> Iterator[str]:
        """Yield the outcomes of starts after a good run, if files broke in between."""
        for robots in (1, 2):
            for name in ("behavior-syntax", "main-syntax", "main-missing-behavior"):
                for more in ((), ("--last-good",)):
                    project = self._project(robots)
                    self._warm.run(["run", project, *LINES["whole"]], project)
                    MISHAPS[name](project)
                    told = " ".join(("then", name, *more))
                    yield f"# {_words(robots)}, whole, {told}\n\n{self._outcome(project, (*LINES['whole'], *more))}"

    def while_one_runs(self) -> Iterator[str]:
        """Yield the outcomes of a second start beside the first, whose folder it leaves alone."""
        for robots in (1, 2):
            project = self._project(robots)
            home = project / ".lumen" / ("" if robots == 1 else "robots/ben")
            first = [sys.executable, "-m", "lumen", "run", project, "--robot", "recording", "--bus", "memory://"]
            env = environment(self._place)
            with Guarded(first, cwd=ROOT, env=env, stdin=DEVNULL, stdout=DEVNULL, stderr=DEVNULL) as process:
                until(lambda home=home: process.poll() is not None or (home / "door.json").exists(), HANG)
                done = self._warm.run(["run", project, *LINES["whole"]], self._place)
                process.kill()
            yield "\n".join([f"# {_words(robots)}, whole", "", *_printed(done, project), *_alerts(project), ""])

    def _project(self, robots: int) -> Path:
        self._count += 1
        return small(self._place / f"{self._count}" / "small", robots=robots)

    def _outcome(self, project: Path, line: Sequence[str]) -> str:
        done = self._warm.run(["run", project, *line], self._place)
        return "\n".join([*_printed(done, project), *_alerts(project), *_kept(project)]) + "\n"


def _words(robots: int) -> str:
    return "one robot" if robots == 1 else "two robots"


def _printed(done: Done, project: Path) -> Iterator[str]:
    yield f"exit code: {done.code}"
    for name, text in (("standard output", done.out), ("standard error", done.err)):
        yield f"{name}:{'' if text else ' nothing'}"
        yield from (f"  {line}" for line in plain(text, project, project.parents[1]).splitlines())


def _alerts(project: Path) -> Iterator[str]:
    file = project / TOLD
    told = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []
    yield f"alerts:{'' if told else ' none'}"
    for alert in told:
        alert |= {"host": "<host>", "at": "<time>", "first": "<time>"}
    yield from sorted(f"  {plain(json.dumps(alert, ensure_ascii=False), project)}" for alert in told)


def _kept(project: Path) -> Iterator[str]:
    """Yield the files of `.lumen/`, with the text of those in JSON."""
    home = project / ".lumen"
    if not home.is_dir():
        yield f"no folder .lumen{' but a file' if home.exists() else ''}"
        return
    yield "in .lumen:"
    for file in sorted(home.rglob("*")):
        if file.is_file():
            text = f": {plain(file.read_text('utf-8'), project)}" if file.suffix == ".json" else ""
            yield f"  {plain(_journals(str(file.relative_to(home))))}{text}"


def _journals(name: str) -> str:
    """Return the name of a file, for a journal without its random end."""
    return f"{name.rpartition('-')[0]}-<id>.journal" if name.endswith(".journal") else name


def _write(file: Path, blocks: Iterator[str]) -> None:
    file.write_text("\n".join(blocks), "utf-8")
