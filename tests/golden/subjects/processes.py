"""Which programs each command begins: their command lines, by who begins them.

Each Python of a command notes what it begins (`noting/`), so that programs that end soon are included. Their number is
left out, since a process that waits to be used again may be begun anew on a slow machine; so are places, numbers of
open files, and ports.
"""

import json
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tests import ROOT
from tests.golden.adapters_running import PROGRAMS
from tests.golden.exhibitions import plain, small
from tests.golden.mishaps import MISHAPS
from tests.golden.served import HANG, Served
from tests.golden.warm import environment
from tests.guarded import DEVNULL, Guarded
from tests.waiting import until

SUITE = "rest"
NOTING = ROOT / "tests/golden/noting"
NOTES = "GOLDEN_NOTES"
WORKER = "spawn_main"
CONSOLE = "lumen console"
"""Of a visit, only the programs that this begins are kept: when the exhibition judges files depends on the machine."""
QUICK = ("--robot", "recording", "--speed", "max", "--for", "1s", "--bus", "memory://")
PYTHON = "python"
NUMBERS = re.compile(r"(?<=[=(])\d+(?=[,)])")
"""Open files that one process leaves to another."""
COMMANDS: dict[str, Sequence[str]] = {
    "run, as fast as it can": ("run", "PROJECT", *QUICK),
    "run, two robots": ("run", "TWO", *QUICK),
    "run, files with errors": ("run", "BROKEN", *QUICK),
    "run, no broker": ("run", "PROJECT", "--only", "robot", "--bus", "amqp://guest:guest@127.0.0.1:1/"),
    "lint": ("lint", "PROJECT"),
    "lint, in physics": ("lint", "PROJECT", "--physics", "--workers", "2"),
    "test": ("test", "PROJECT"),
    "alerts test": ("alerts", "test", "PROJECT"),
}


def record(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place:
        here = Path(place).resolve()
        lines: list[str] = []
        for name, found in _all(here):
            lines += [f"# {name}", "", *([f"  {line}" for line in found] or ["  nothing"]), ""]
        (folder / "begun.txt").write_text("\n".join(lines), "utf-8")


def _all(here: Path) -> Iterator[tuple[str, list[str]]]:
    places = {"PROJECT": small(here / "one"), "TWO": small(here / "two", robots=2), "BROKEN": small(here / "broken")}
    MISHAPS["behavior-syntax"](places["BROKEN"])
    for name, line in COMMANDS.items():
        words = [str(places.get(word, word)) for word in line]
        yield name, _noted(here, lambda env, words=words: _run(words, here, env))
    begun = _noted(here, lambda env: _visit(here, env))
    yield "the console, asked for pages", [line for line in begun if CONSOLE in line.partition(" → ")[0]]


def _run(words: Sequence[str], here: Path, env: dict[str, str]) -> None:
    """Run a command to its end, or until it has begun its workers, whose work is long."""
    command = [sys.executable, "-m", "lumen", *words]
    notes = Path(env[NOTES])
    with Guarded(
        command, cwd=here, env=environment(here) | env, stdin=DEVNULL, stdout=DEVNULL, stderr=DEVNULL
    ) as process:
        until(lambda: process.poll() is not None or (notes.exists() and WORKER in notes.read_text("utf-8")), HANG)
        process.kill()


def _visit(here: Path, env: dict[str, str]) -> None:
    project = small(here / "visited")
    with Served(project, here, pins=env) as served:
        for path in ("/api/day", "/api/why", "/api/files", "/api/shape"):
            served.ask("GET", path)


def _noted(here: Path, do: Callable[[dict[str, str]], None]) -> list[str]:
    """Call `do`, and return each pair of a program and its child once."""
    notes = here / "notes"
    notes.unlink(missing_ok=True)
    do({NOTES: str(notes), "PYTHONPATH": f"{NOTING}:{ROOT}"})
    noted = [json.loads(line) for line in notes.read_text("utf-8").splitlines()] if notes.exists() else []
    return sorted({f"{_told(parent, here)} → {_told(child, here)}" for parent, child in noted})


def _told(words: Sequence[str], here: Path) -> str:
    first = PYTHON if Path(words[0]).name.startswith("python") else words[0]
    text = NUMBERS.sub("…", " ".join([first, *words[1:]]))
    program = shutil.which(words[0])
    if program and program == words[0] and first != PYTHON:
        text = text.replace(program, Path(program).name)
    for module, name in PROGRAMS.items():
        text = text.replace(f"-m {module}", name)
    return re.sub(r"--port \d+", "--port <port>", plain(text, here))
