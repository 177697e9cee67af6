"""The stand-in for the visual module: a face detector that is never wrong, and takes its time."""

from collections import deque

from lumen.language.projects import Project
from lumen.language.routes import Route
from lumen.ports import Bus, Hall

PERIOD = 0.1
LATENCY = 0.1
ROUTE = "face"


class FaceDetector:
    """Publishes where the visitor's face stands in the camera's image [px], ten times a second, 0.1 s late.

    The body is the original's (`x`, `y` as integers) and `time` [s], when the image was taken.
    """

    def __init__(self, project: Project, hall: Hall, bus: Bus) -> None:
        self._hall, self._bus = hall, bus
        self._route: Route | None = project.routes.get(ROUTE)
        self._robot, self.camera = project.robot, project.body.camera
        self._next = 0.0
        self._developing: deque[tuple[float, dict[str, object]]] = deque()
        self.last: tuple[float, float] | None = None

    def tick(self, now: float) -> None:
        """Look, where it is time to, and publish what has been recognised by now."""
        if self._route is None:
            return
        if now >= self._next:
            self._next += PERIOD
            self._look(now)
        while self._developing and self._developing[0][0] <= now:
            self._bus.publish(self._route.key_for(self._robot), self._developing.popleft()[1])

    def _look(self, now: float) -> None:
        self.last = self._hall.face()
        if self.last:
            x, y = self.last
            self._developing.append((now + LATENCY, {"x": round(x), "y": round(y), "time": now}))
