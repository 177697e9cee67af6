"""Whom the memory has forgotten all others forget, also while they stand there."""

from collections import deque
from collections.abc import Callable, Sequence

from lumen.app.parts.part import Part
from lumen.language.events import Event
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.modules.module import DEFAULT_KEYS
from lumen.ports import Bus, Message

ROUTE = "forgotten"
MAX_PENDING_NAMES = 100


class ForgettingPart(Part):
    """Has what this process remembers and has written down forget somebody: each of `forget` is called with the name.

    It stands before the brain, whose `needs` it has where there is one.
    """

    def __init__(
        self, project: Project, bus: Bus, *forget: Callable[[PersonName], None], needs: Sequence[str] = ()
    ) -> None:
        self.needs, self._forget = needs, forget
        self._messages: deque[Message] = deque(maxlen=MAX_PENDING_NAMES)
        row = project.routes.get(ROUTE)
        key = row.key_for(project.robot) if row else DEFAULT_KEYS[ROUTE].replace("{robot}", project.robot)
        self._unsubscribe = bus.subscribe(key, self._messages.append)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        while self._messages:
            match self._messages.popleft().body:
                case {"name": str(name)} if name_key(name):
                    for forget in self._forget:
                        forget(PersonName(name))

    def close(self) -> None:
        self._unsubscribe()
