"""Stored recordings, and their comparison with the engine's present results.

A subject is a module of `tests/golden/subjects` with

- `SUITE`: "test" if it is deterministic, without a process, network or physics; else "rest";
- `GROUP`, if it shares work with other tests: their group of pytest-xdist;
- `record(folder)`: writes its files into an empty folder, the same bytes on each machine and at each run;
- if it can say more than a difference does, `explain(recorded, now)`: yields sentences for a failure.

`python scripts/golden.py SUBJECT …` records; `tests/golden/test_golden.py` compares.
"""

import pkgutil
from collections.abc import Callable, Iterable
from difflib import unified_diff
from importlib import import_module
from pathlib import Path
from types import ModuleType

from tests.golden import subjects

HERE = Path(__file__).parent
RECORDED = HERE / "recorded"
PROJECTS = HERE / "projects"
"""Copies of tour, museum and minimal as they were at d475a3ac; they never change."""
SHIPPED = ("minimal", "museum", "tour")
"""Those of them that come with Lumen."""
MOST_LINES = 40
"""The number of lines of a difference that a failure shows, for each file."""


def names() -> list[str]:
    """Return the names of all subjects."""
    return sorted(module.name for module in pkgutil.iter_modules(subjects.__path__))


def subject(name: str) -> ModuleType:
    """Return a subject's module."""
    return import_module(f"{subjects.__name__}.{name}")


def differences(recorded: Path, now: Path) -> list[str]:
    """Return a sentence for each file that is missing, new or different, with the lines that differ if it is text."""
    before, after = _files(recorded), _files(now)
    found = [f"{name}: recorded, and not written any more" for name in sorted(before.keys() - after.keys())]
    found += [f"{name}: written now, and not recorded" for name in sorted(after.keys() - before.keys())]
    for name in sorted(before.keys() & after.keys()):
        if before[name].read_bytes() != after[name].read_bytes():
            found.append(f"{name} differs:\n{_difference(before[name], after[name])}")
    return found


def record(name: str, folder: Path) -> None:
    """Write the present recording of a subject into an empty folder."""
    folder.mkdir(parents=True, exist_ok=True)
    make: Callable[[Path], None] = subject(name).record
    make(folder)


def explanations(name: str, recorded: Path, now: Path) -> list[str]:
    """Return a subject's own explanations of a difference."""
    explain: Callable[[Path, Path], Iterable[str]] = getattr(subject(name), "explain", lambda *_: ())
    return list(explain(recorded, now))


def _files(folder: Path) -> dict[str, Path]:
    return {str(file.relative_to(folder)): file for file in folder.rglob("*") if file.is_file()}


def _difference(before: Path, after: Path) -> str:
    try:
        texts = [file.read_text("utf-8").splitlines() for file in (before, after)]
    except UnicodeDecodeError:
        return f"{before.stat().st_size} bytes recorded, {after.stat().st_size} bytes now"
    lines = list(unified_diff(*texts, "recorded", "now", lineterm="", n=1))
    more = [f"… {len(lines) - MOST_LINES} more lines"] if len(lines) > MOST_LINES else []
    return "\n".join([*lines[:MOST_LINES], *more])
