"""Messages on some routes of the bus, kept in order until they are read; the routes may change."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator

from lumen.language.projects import Project
from lumen.ports import Bus, Message

MAX_WAITING_MESSAGES = 1000
"""Messages that may wait; one more drops the oldest."""


class RouteInbox:
    """A queue of the newest `MAX_WAITING_MESSAGES` messages, with the names of their routes."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._waiting: deque[tuple[str, Message]] = deque(maxlen=MAX_WAITING_MESSAGES)
        self._undo: dict[tuple[str, str], Callable[[], None]] = {}

    def listen(self, project: Project, names: Iterable[str]) -> None:
        """Subscribe to those of the named routes that the project has, and to no others."""
        routes = {name: route for name in names if (route := project.routes.get(name))}
        wanted = {(route.key_for(project.robot), name) for name, route in routes.items()}
        for key, name in sorted(wanted - self._undo.keys()):
            self._undo[key, name] = self._bus.subscribe(key, self._receiver(name))
        for gone in sorted(self._undo.keys() - wanted):
            self._undo.pop(gone)()

    def taken(self) -> Iterator[tuple[str, Message]]:
        """Remove and yield the messages, the oldest first."""
        while self._waiting:
            yield self._waiting.popleft()

    def _receiver(self, route: str) -> Callable[[Message], None]:
        return lambda message: self._waiting.append((route, message))
