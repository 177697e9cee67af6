"""What is known here of a robot that does not answer: how its last run ended, and who had stopped it."""

from pathlib import Path
from typing import Any

from lumen.language.iso_time import iso_time
from lumen.project.home import Home, home_of
from lumen.run.parts.kept_hold import kept_hold
from lumen.run.snapshot_store import SnapshotStore


def last_run(root: Path, robot: str) -> dict[str, Any]:
    """How a robot of the project in `root` is that does not answer, as JSON data.

    `held` is whether a process of this machine has its home all the same. `ended` is when its last run was last known
    to live (ISO 8601), `told` whether the system had told it to end; None and false where nothing is left of it.
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
