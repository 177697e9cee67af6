"""A replacement for the visual module: a face detector without errors, but with a delay."""

import logging
from collections import deque

from lumen.language.projects import Project
from lumen.ports import Bus, Hall
from lumen.run.sending import send

_log = logging.getLogger(__name__)

FACE_PERIOD = 0.1
"""The time between two images [s]."""
FACE_LATENCY = 0.1
"""The time from an image to its message [s]."""
FACE_ROUTE = "face"


class FaceDetector:
    """A publisher of the visitor's face in the camera's image [px], every `period` [s] and `latency` [s] late.

    The body has the integers `x` and `y`, as the visual module of 2015 sent them, and `time`, when the image was taken
    [s]. While `quiet` is set, another process publishes real faces instead.
    """

    def __init__(
        self, project: Project, hall: Hall, bus: Bus, *, period: float = FACE_PERIOD, latency: float = FACE_LATENCY
    ) -> None:
        self._hall, self._bus = hall, bus
        self._period, self._latency = period, latency
        self.camera = project.body.camera
        self._next, self.quiet = 0.0, False
        self._developing: deque[tuple[float, dict[str, object]]] = deque()
        self.last: tuple[float, float] | None = None
        self.use(project)

    @property
    def busy(self) -> bool:
        """Whether a face is seen, or a message waits to be published."""
        return bool(self._developing) or self._hall.face() is not None

    def use(self, project: Project) -> None:
        """Switch to this project's route, or stop publishing if the project has no such route."""
        self._project = project

    def tick(self, now: float) -> None:
        """Take an image if one is due, and publish the faces whose latency has passed."""
        if FACE_ROUTE not in self._project.routes:
            return
        if now >= self._next:
            self._next = max(self._next + self._period, now)
            self._look(now)
        if self.quiet:
            self._developing.clear()
        while self._developing and self._developing[0][0] <= now:
            if reason := send(self._bus, self._project, FACE_ROUTE, self._developing.popleft()[1]):
                _log.warning("a face could not be published: %s", reason)

    def leap(self, now: float) -> None:
        """Set the time to `now` [s] after an interval without a face."""
        while self._next <= now:
            self._next += self._period

    def _look(self, now: float) -> None:
        self.last = self._hall.face()
        if self.last:
            x, y = self.last
            self._developing.append((now + self._latency, {"x": round(x), "y": round(y), "time": now}))
