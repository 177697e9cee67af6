"""Where `--video` may write."""

import os
from pathlib import Path

from lumen.errors import UsageError


def film_path(path: Path | None, robot: str) -> Path | None:
    """Where a film may be written; raises UsageError where it may not."""
    if path is None:
        return None
    if robot != "simulation":
        raise UsageError("--video films the simulation: leave out --robot")
    if path.suffix != ".mp4" or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise UsageError(
            f"can't write a film to {path}: name an .mp4 file in a folder that is there and yours to write"
        )
    return path
