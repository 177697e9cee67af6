"""The behaviour forgets whom the memory has forgotten, also while they stand there."""

from collections import deque
from collections.abc import Callable, Sequence

from lumen.app.live_behavior import LiveBehavior
from lumen.app.parts.part import Part
from lumen.language.events import Event
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.modules.module import DEFAULT_KEYS
from lumen.ports import Bus, Message

ROUTE = "forgotten"
MAX_PENDING_NAMES = 100


class ForgettingPart(Part):
    """Takes the name out of what the behaviour remembers; it stands before the brain, whose `needs` it has.

    `forget` does the same for what is written down of the run.
    """

    def __init__(
        self,
        project: Project,
        bus: Bus,
        behavior: LiveBehavior,
        forget: Callable[[PersonName], None] = lambda _: None,
        needs: Sequence[str] = (),
    ) -> None:
        self.needs, self._behavior, self._forget = needs, behavior, forget
        self._messages: deque[Message] = deque(maxlen=MAX_PENDING_NAMES)
        row = project.routes.get(ROUTE)
        key = row.key_for(project.robot) if row else DEFAULT_KEYS[ROUTE].replace("{robot}", project.robot)
        self._unsubscribe = bus.subscribe(key, self._messages.append)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        while self._messages:
            match self._messages.popleft().body:
                case {"name": str(name)} if name_key(name):
                    person = PersonName(name)
                    self._behavior.forget(person)
                    self._forget(person)

    def close(self) -> None:
        self._unsubscribe()
