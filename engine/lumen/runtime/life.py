"""Tells the robot in which style it is alive, as the active states say."""

from lumen.interpreters.life import style_name
from lumen.interpreters.statechart import Snapshot
from lumen.language.life import STILL_STYLE, LifeStyle
from lumen.language.projects import Project
from lumen.ports import Live, Robot

REMIND_PERIOD = 5.0
"""How long after the last time the robot is told again [s]: one that was restarted meanwhile has forgotten it."""


class LifeDirector:
    """Watches where the behaviour stands. It takes no part in its steps, so that journals know nothing of it."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._told: LifeStyle = STILL_STYLE
        self._told_at = 0.0
        self._seen: tuple[object, object] = (None, None)
        self._wanted = STILL_STYLE

    def tick(self, project: Project, snapshot: Snapshot, now: float) -> None:
        """Tell the robot where that is another style, or its file has changed; and again now and then."""
        if self._seen[0] is not project or self._seen[1] != snapshot.configuration:
            self._seen = project, snapshot.configuration
            name = style_name(project.machine, snapshot.configuration)
            self._wanted = project.life.get(name, STILL_STYLE)
        reminds = self._wanted is not STILL_STYLE and now >= self._told_at + REMIND_PERIOD
        if self._wanted != self._told or reminds:
            self._told, self._told_at = self._wanted, now
            self._robot.start("", Live(self._wanted))
