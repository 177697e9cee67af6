"""Saved files that are tried for one visitor."""

from lumen.insight.replay.visits import home_of
from lumen.language.projects import Project
from lumen.statechart import Snapshot


class Trial:
    """A bundle that runs until a visit is over: the one that is under way, or else the next.

    Its visits end where the behaviour is back in the state in which it waits for a visitor.
    """

    def __init__(self, project: Project) -> None:
        self._home, self._away = home_of(project.machine), False

    def over(self, snapshot: Snapshot) -> bool:
        """Whether the visit has come to its end, as the behaviour stands now."""
        home = self._home in snapshot.configuration
        self._away |= not home
        return home and self._away
