"""Third-party packages, and expensive ones of Python, that three commands import, each in a process of its own.

The engine's own modules are not listed, since they move; neither is what Python imports before it runs anything.
"""

import json
import shutil
import sys
import time
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType

from tests.golden.command_line import CHECKOUT, environment
from tests.golden.golden import PROJECTS
from tests.guarded import run_guarded, temporary_folder
from tests.waiting import until

SUITE = "rest"
BEGIN = "--- imported"
CODE = f"""
import atexit, json, sys

class Watch:
    importers = {{}}

    @classmethod
    def find_spec(cls, name, path=None, target=None):
        frame, chain = sys._getframe(1), []
        while frame:
            module = frame.f_globals.get("__name__", "")
            if not module.startswith("importlib") and module not in chain:
                chain.append(module)
            if module.startswith("lumen."):
                break
            frame = frame.f_back
        cls.importers.setdefault(name.partition(".")[0], chain[::-1])

sys.meta_path.insert(0, Watch)
atexit.register(lambda: print({BEGIN!r}, json.dumps(Watch.importers), file=sys.stderr))
from lumen.cli.main import main
sys.exit(main(sys.argv[1:]))
"""
"""Runs a command, and prints which packages were looked for: by whom, up to the engine's module that began it."""
DEAR = frozenset((
    "asyncio", "concurrent", "ctypes", "decimal", "email", "http", "inspect", "multiprocessing", "sqlite3", "ssl",
    "subprocess", "tomllib", "unittest", "urllib", "xml", "zipfile",
))  # fmt: skip
"""Packages of Python that take long to import."""
ENGINE = "lumen"
KEPT_AFTER = 3.0
"""A little more than the age of files from which on the engine keeps what it found in them [s]."""
COMMANDS = {
    "version": ("--version",),
    "lint-cold": ("lint",),
    "lint-kept": ("lint",),
    "run-recording": ("run", "--robot", "recording", "--speed", "max", "--story", "visitor"),
}


def record(folder: Path) -> None:
    """Write the sorted names for each command, one on a line."""
    for command in COMMANDS:
        names = sorted(imported()[command])
        (folder / f"{command}.txt").write_text("".join(f"{name}\n" for name in names), "utf-8")


def explain(recorded: Path, now: Path) -> Iterator[str]:
    """Yield a sentence for each package that a command did not import when it was recorded."""
    for command, words in COMMANDS.items():
        files = (recorded / f"{command}.txt", now / f"{command}.txt")
        before, after = (set(file.read_text("utf-8").split()) if file.is_file() else set() for file in files)
        for name in sorted(after - before):
            yield f"`lumen {' '.join(words)}` ({command}) imports {name} now: {imported()[command][name]}"


@cache
def imported() -> MappingProxyType[str, dict[str, str]]:
    """Return, for each command, its packages and which modules led to them."""
    work = temporary_folder("lumen-imports-")
    project = work / "minimal"
    shutil.copytree(PROJECTS / "minimal", project)
    _settle(project)
    variables = {**environment(work), "PYTHONPATH": str(CHECKOUT / "engine")}
    found = {}
    for command, words in COMMANDS.items():
        call = [sys.executable, "-c", CODE, *words]
        done = run_guarded(call, cwd=project, env=variables, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, f"lumen {' '.join(words)} ended with {done.returncode}: {done.stderr[-2000:]}"
        assert BEGIN in done.stderr, done.stderr[-2000:]
        found[command] = _packages(done.stderr.rpartition(BEGIN)[2])
    shutil.rmtree(work)
    return MappingProxyType(found)


def _packages(report: str) -> dict[str, str]:
    """Return the packages that count, with the modules that led to each."""
    importers: dict[str, list[str]] = json.loads(report)
    assert ENGINE in importers, report
    return {name: " imports ".join([*chain, name]) for name, chain in importers.items() if _counts(name)}


@cache
def _counts(package: str) -> bool:
    """Return whether to list it: it is no part of Python or the engine, and was not only looked for in vain."""
    if package in DEAR:
        return True
    known = package.startswith("_") or package in (ENGINE, *sys.stdlib_module_names)
    return not known and find_spec(package) is not None


def _settle(project: Path) -> None:
    """Wait until the files are old enough for lint to keep its findings: a change must show in their times."""
    newest = max(file.stat().st_ctime for file in (project, *project.rglob("*")))
    until(lambda: time.time() > newest + KEPT_AFTER)
