"""That a person stopped the robot, kept for a run after a crash."""

from datetime import datetime
from pathlib import Path

from lumen.robots.person_hold import PersonHold, StoppedBy
from lumen.runtime.home import Home

STOPPED_FILE = "stopped.json"


def keep_hold(hold: PersonHold, folder: Path) -> None:
    """Hold the robot where the run before left it stopped, and keep in this folder who stops it from now on."""
    home = Home(folder)

    def keep(stopped: StoppedBy | None) -> None:
        if stopped:
            home.write_json(STOPPED_FILE, {"by": stopped.by, "since": stopped.since.isoformat()})
        else:
            home.remove(STOPPED_FILE)

    hold.changed.append(keep)
    if before := kept_hold(home):
        hold.stop(before.by, before.since)


def forget_hold(folder: Path) -> None:
    """The run ends as a person wants it: the next one begins as usual."""
    Home(folder).remove(STOPPED_FILE)


def kept_hold(home: Home) -> StoppedBy | None:
    """Who had stopped the robot when the run before ended; None where nobody had."""
    found = home.read_json(STOPPED_FILE)
    try:
        return StoppedBy(str(found["by"]), datetime.fromisoformat(found["since"]))
    except (ValueError, TypeError, KeyError):
        return None
