"""Refuse a golden that changes unseen: `python scripts/golden_guard.py` checks each commit of this branch.

It checks the commits since the common ancestor with `origin/main` or `main` (if there are none, the last one), and the
uncommitted changes as one more commit. It refuses:

- a change under tests/golden/recorded/ together with more than 50 changed lines of engine/;
- a changed or deleted recording without an added or changed record under docs/decisions/.

A first recording needs no record, and neither does a floor of the counted tests that rises.
"""

import json
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

RECORDED = "tests/golden/recorded/"
FLOORS = f"{RECORDED}collected/floors.json"
"""The least number of tests, by folder: tests/golden/collected.py."""
DECISIONS = "docs/decisions/"
ENGINE = "engine/"
MOST_LINES = 50
"""Lines of the engine, added and removed together: a larger change moves or rewrites something."""


class Change(NamedTuple):
    """A file that a commit changed: `A`dded, `M`odified, `D`eleted, with the lines added and removed."""

    kind: str
    path: str
    lines: int


def main(root: Path) -> int:
    """Print a sentence for each refused commit; return 1 if there is any."""
    if not _git(root, "rev-parse", "--git-dir"):
        print("no git repository: changes of goldens are not checked", file=sys.stderr)
        return 0
    found = [f"{name}: {fault}" for name, changes in _commits(root) for fault in _faults(root, name, changes)]
    print(*found, sep="\n", end="\n" if found else "", file=sys.stderr)
    return int(bool(found))


def _commits(root: Path) -> Iterator[tuple[str, list[Change]]]:
    """Yield the name of each commit, the work tree last, with its changes."""
    head = _git(root, "rev-parse", "--verify", "HEAD")
    bases = [found for name in ("origin/main", "main") for found in _git(root, "merge-base", "HEAD", name)]
    base = [one for one in bases if [one] != head][:1] or _git(root, "rev-parse", "--verify", "HEAD~1")
    for commit in _git(root, "rev-list", "--reverse", "--no-merges", f"{base[0]}..HEAD") if base else []:
        yield commit[:12], _changes(root, f"{commit}~1", commit)
    if head:
        new = [Change("A", path, _length(root / path)) for path in _git(root, "ls-files", "-o", "--exclude-standard")]
        yield "what is not committed", _changes(root, "HEAD") + new


def _changes(root: Path, *between: str) -> list[Change]:
    words = ("diff", "-M", "--relative", *between)
    kinds = [line.split("\t") for line in _git(root, *words, "--name-status", "--no-renames")]
    lines = {path: _number(added) + _number(removed) for added, removed, path in _numbers(root, words)}
    return [Change(kind[0], path, lines.get(path, 0)) for kind, path in kinds]


def _numbers(root: Path, words: tuple[str, ...]) -> Iterator[tuple[str, str, str]]:
    """Yield lines added, lines removed and path of each file; a file that only moved has 0 lines."""
    fields = iter("\n".join(_git(root, *words, "--numstat", "-z")).split("\0"))
    for field in fields:
        if field:
            added, removed, path = field.split("\t")
            if not path:  # a rename: the old path and the new one follow
                _, path = next(fields), next(fields)
            yield added, removed, path


def _faults(root: Path, name: str, changes: list[Change]) -> Iterator[str]:
    goldens = [one for one in changes if one.path.startswith(RECORDED) and not _rises(root, name, one)]
    lines = sum(one.lines for one in changes if one.path.startswith(ENGINE))
    if goldens and lines > MOST_LINES:
        yield (
            f"{goldens[0].path} is recorded together with {lines} changed lines of {ENGINE}: at most {MOST_LINES} are"
            " allowed; change the engine in another commit"
        )
    again = [one.path for one in goldens if one.kind != "A"]
    told = any(one.path.startswith(DECISIONS) and one.kind != "D" for one in changes)
    if again and not told:
        more = f" and {len(again) - 1} more" if len(again) > 1 else ""
        yield (
            f"{again[0]}{more} changed without a record of the decision: add or change one under {DECISIONS} in the"
            " same commit"
        )


def _rises(root: Path, name: str, change: Change) -> bool:
    """Return True if the change is one of the floors, of which none falls."""
    if change.path != FLOORS or change.kind != "M":
        return False
    worktree = " " in name
    before = json.loads("\n".join(_git(root, "show", f"{'HEAD' if worktree else f'{name}~1'}:{FLOORS}")))
    after = json.loads(
        (root / FLOORS).read_text("utf-8") if worktree else "\n".join(_git(root, "show", f"{name}:{FLOORS}"))
    )
    return all(
        after.get(folder, {}).get(kind, -1) >= count
        for folder, counts in before.items()
        for kind, count in counts.items()
    )


def _number(text: str) -> int:
    return int(text) if text.isdigit() else 0  # `-` for a binary file


def _length(file: Path) -> int:
    return file.read_bytes().count(b"\n") if file.is_file() else 0


def _git(root: Path, *words: str) -> list[str]:
    """Return the lines that git prints; none if it fails, or if there is no git."""
    if not shutil.which("git"):
        return []
    command = ["git", "-c", "core.quotePath=false", *words]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return done.stdout.splitlines() if done.returncode == 0 else []


if __name__ == "__main__":
    sys.exit(main(Path(__file__).parents[1]))
