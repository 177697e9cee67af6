"""The active states of the open projects' exhibitions on this machine."""

from collections.abc import Callable, Iterable
from pathlib import Path
from threading import Event

from lumen.errors import LumenError
from lumen.language.operator_requests import STATUS
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.reaching import Reached, reach_exhibition, runs_here

ASK_EVERY, ANSWER_TIMEOUT = 1.0, 2.0
"""The time between two requests for the exhibitions' states, and the maximum wait for an answer [s]."""


class RunningExhibitions:
    """Requests the active states of the open projects' running exhibitions.

    `roots` returns the projects' folders. `changed` is called with a folder when its exhibition's active states
    change.
    """

    def __init__(self, roots: Callable[[], Iterable[Path]], changed: Callable[[Path], None]) -> None:
        self._roots, self._changed = roots, changed
        self._active: dict[Path, tuple[str, ...]] = {}
        self._reached: dict[Path, Reached] = {}
        self._over = Event()

    def active(self, root: Path) -> tuple[str, ...]:
        """Return the names of the active states in a project's exhibition; empty if it is not running."""
        return self._active.get(root, ())

    def follow(self) -> None:
        """Request the states of all exhibitions repeatedly until `close` is called, then close their buses."""
        while not self._over.wait(ASK_EVERY):
            for root in list(self._roots()):
                states = self._asked(root)
                if states != self.active(root):
                    self._active[root] = states
                    self._changed(root)
        for reached in self._reached.values():
            reached.bus.close()

    def close(self) -> None:
        """End `follow` before its next round."""
        self._over.set()

    def _asked(self, root: Path) -> tuple[str, ...]:
        try:
            if not runs_here(root):
                self._lose(root)
                return ()
            if root not in self._reached:
                self._reached[root] = reach_exhibition(str(root), None)
            found = self._reached[root]
            key = operator_key(found.robot)
            status = next(send_request(found.bus, key, STATUS(), OPERATOR_ANSWERS, first=ANSWER_TIMEOUT))
            return tuple(map(str, status["configuration"]))
        except (LumenError, KeyError, TypeError, StopIteration):
            self._lose(root)
            return ()

    def _lose(self, root: Path) -> None:
        if (reached := self._reached.pop(root, None)) is not None:
            reached.bus.close()
