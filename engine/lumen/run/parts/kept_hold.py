"""The person who stopped the robot, saved for a run after a crash."""

from datetime import datetime
from pathlib import Path

from lumen.project.home import Home
from lumen.robot.command_receiver import CommandListener
from lumen.robot.person_hold import PersonHold, StoppedBy

STOPPED_FILE = "stopped.json"


class KeptHold(CommandListener):
    """A listener that saves in `folder` who stopped the robot and when, for the run after a crash."""

    def __init__(self, folder: Path) -> None:
        self._home = Home(folder)

    def held(self, stopped: StoppedBy | None) -> None:
        """Save who stopped the robot and when in STOPPED_FILE; delete that file if the robot may move again (None).

        Errors of the disk are ignored.
        """
        if stopped:
            self._home.write_json(STOPPED_FILE, {"by": stopped.by, "since": stopped.since.isoformat()})
        else:
            self._home.remove(STOPPED_FILE)

    def restore(self, hold: PersonHold) -> None:
        """Hold the robot again, with the saved person and time, if it was stopped when the previous run ended."""
        if before := kept_hold(self._home):
            hold.stop(before.by, before.since)


def forget_hold(folder: Path) -> None:
    """Delete the saved hold, so that the next run begins with a robot that may move."""
    Home(folder).remove(STOPPED_FILE)


def kept_hold(home: Home) -> StoppedBy | None:
    """Return who had stopped the robot when the previous run ended, and when.

    Return None if the robot was not stopped, or if STOPPED_FILE can't be read.
    """
    found = home.read_json(STOPPED_FILE)
    try:
        return StoppedBy(str(found["by"]), datetime.fromisoformat(found["since"]))
    except (ValueError, TypeError, KeyError):
        return None
