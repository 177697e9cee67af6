"""The recorded journals, replayed: every step, and the snapshot after it.

A line for each entry: position, how, event and time, the states left (-) and entered (+), the commands, and the digest
that a journal has of a step. Below it a digest of the snapshot as it is written to the disk, and what changed in it.
Entries of one kind that change nothing but the time are one line.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.golden.adapters import KeptBundles, Replayed, replayed
from tests.golden.kept import bundles, journals
from tests.golden.texts import digest, in_one_line, write

SUITE = "test"


def record(folder: Path) -> None:
    """Write a file for each journal."""
    for name, files in journals().items():
        _, _, robot = name.partition("/")
        lines = [line for file in files for line in steps(file, bundles(robot))]
        write(folder / f"{name.replace('/', '-')}.txt", lines)


def steps(file: Path, kept: KeptBundles) -> Iterator[str]:
    """Yield the lines of a file of a journal."""
    before: dict[str, Any] = {}
    alike: list[tuple[Replayed, str]] = []
    for row in replayed(file, kept):
        now = row.snapshot or before
        changed = {key: value for key, value in now.items() if before.get(key) != value}
        whole, before = digest([in_one_line(now)]), now
        told = row.exited or row.entered or row.commands or row.entry.get("said") or row.differs or row.unknown
        quiet = changed.keys() <= {"at"} and not told
        if alike and not (quiet and _what(alike[0][0]) == _what(row)):
            yield together(alike)
            alike = []
        if quiet:
            alike.append((row, whole))
            continue
        yield step_line(row)
        if row.unknown:
            yield f"  unknown: {row.unknown}"
        if row.differs:
            yield from (f"  was {row.differs[0]}", f"  is  {row.differs[1]}")
        yield f"  {whole} {in_one_line(changed)}"
    if alike:
        yield together(alike)


def step_line(row: Replayed) -> str:
    """Return an entry and its outcome as a line."""
    how, what = _what(row)
    words = [str(row.position), how, what, f"{row.entry['at']!r}"]
    words += [f"-{state}" for state in row.exited] + [f"+{state}" for state in row.entered]
    words += [in_one_line(row.commands)] * bool(row.commands) + [f"({row.digest})"] * bool(row.digest)
    words += [in_one_line(said)] if (said := row.entry.get("said")) else []
    return " ".join(words)


def together(alike: list[tuple[Replayed, str]]) -> str:
    """Return one line for consecutive entries of one kind that change nothing, with a digest of their times."""
    (first, whole), (last, _) = alike[0], alike[-1]
    if first is last:
        return f"{step_line(first)} {whole}"
    all_of_them = digest(f"{row.entry['at']!r} {row.digest} {whole}" for row, whole in alike)
    how, what = _what(first)
    times = f"{first.position}..{last.position} {how} {what} {first.entry['at']!r}..{last.entry['at']!r}"
    return f"{times} changes nothing, {len(alike)} times: {all_of_them}"


def _what(row: Replayed) -> tuple[str, str]:
    """Return how an entry came and what it is: `heard face`, `jump start`."""
    how = next(iter(row.entry))
    return how, row.entry[how]
