"""Tells the robot in which style it is alive, and with which gestures it speaks, as the active states say."""

from lumen.language.gestures import NO_GESTURES, merged
from lumen.language.life import STILL_STYLE
from lumen.language.projects import Project
from lumen.motion.life import gestures_wanted, style_name
from lumen.ports import Live, Robot
from lumen.statechart import Snapshot

REMIND_PERIOD = 5.0
"""How long after the last time the robot is told again [s]: one that was restarted meanwhile has forgotten it."""

_STILL = Live(STILL_STYLE)


class LifeDirector:
    """Watches where the behaviour stands. It takes no part in its steps, so that journals know nothing of it."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._told, self._wanted = _STILL, _STILL
        self._told_at = 0.0
        self._seen: tuple[object, object] = (None, None)

    def tick(self, project: Project, snapshot: Snapshot, now: float) -> None:
        """Tell the robot where that is something else, or a file has changed; and again now and then."""
        if self._seen[0] is not project or self._seen[1] != snapshot.configuration:
            self._seen = project, snapshot.configuration
            self._wanted = _wanted(project, snapshot)
        reminds = self._wanted is not _STILL and now >= self._told_at + REMIND_PERIOD
        if self._wanted != self._told or reminds:
            self._told, self._told_at = self._wanted, now
            self._robot.start("", self._wanted)


def _wanted(project: Project, snapshot: Snapshot) -> Live:
    style = project.life.get(style_name(project.machine, snapshot.configuration))
    if style is None:
        return _STILL
    speaks = gestures_wanted(project.machine, snapshot.configuration)
    return Live(style, merged(project.gestures) if speaks else NO_GESTURES)
