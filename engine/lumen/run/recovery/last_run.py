"""Local records about a robot that does not answer: the end of its last run, and who had stopped it."""

from pathlib import Path
from typing import Any

from lumen.language.iso_time import iso_time
from lumen.project.home import Home, home_of
from lumen.run.parts.kept_hold import kept_hold
from lumen.run.snapshot_store import SnapshotStore


def last_run(root: Path, robot: str) -> dict[str, Any]:
    """Return the state of a robot that does not answer, as JSON data; `root` is the project's folder.

    `held` is whether a process of this machine still has its home. `ended` is the last known moment of its last run
    (ISO 8601), None if unknown. `told` is whether the operating system had ordered that end.
    """
    home = Home(home_of(root, robot))
    kept, stopped = SnapshotStore(home).kept(), kept_hold(home)
    return {
        "robot": robot,
        "running": False,
        "held": home.held(),
        "ended": iso_time(kept.ended) if kept else None,
        "told": kept is not None and kept.told,
        "stopped": stopped is not None,
        "stopped_by": stopped.by if stopped else None,
    }
