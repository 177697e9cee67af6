"""Searches for files that tests check: one that finds nothing fails, for a check of nothing always passes."""

from pathlib import Path


def matching(folder: Path, *patterns: str) -> list[Path]:
    """Return the sorted files beneath a folder that match a pattern; fail if one of the patterns matches nothing."""
    found: set[Path] = set()
    for pattern in patterns:
        files = list(folder.glob(pattern))
        assert files, f"no file matches {pattern} in {folder}: the files have moved, or the pattern is wrong"
        found.update(files)
    return sorted(found)
