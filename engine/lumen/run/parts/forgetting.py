"""Whom the memory has forgotten all others forget, also while they stand there."""

import logging
from collections import deque
from collections.abc import Callable, Sequence

from lumen.language.events import Event
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, Message
from lumen.run.parts.part import Part
from lumen.upkeep.drops import DropLog

ROUTE = "forgotten"
MAX_PENDING_NAMES = 100
"""Names that wait at a time; what comes then is dropped, and told."""
FORGETTING_SPACING = 2.0
"""How long after one name the next is looked for in all files [s]: who sends a thousand names keeps nobody busy."""

_log = logging.getLogger(__name__)


class ForgettingPart(Part):
    """Has what this process remembers and has written down forget somebody: each of `forget` is called with the name.

    One name at a time, and one that waits already not twice. It stands before the brain, whose `needs` it has where
    there is one.
    """

    patient = True

    def __init__(
        self, project: Project, bus: Bus, *forget: Callable[[PersonName], None], needs: Sequence[str] = ()
    ) -> None:
        self.needs, self._forget = needs, forget
        self._messages: deque[Message] = deque(maxlen=MAX_PENDING_NAMES)
        self._waiting: dict[str, str] = {}
        self._drops, self._last = DropLog(_log), -FORGETTING_SPACING
        row = project.routes.get(ROUTE)
        key = row.key_for(project.robot) if row else default_key(ROUTE, project.robot)
        self._unsubscribe = bus.subscribe(key, self._messages.append)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._gather()
        if self._waiting and now - self._last >= FORGETTING_SPACING:
            self._last = now
            self._forget_next()

    def close(self) -> None:
        """Forget whoever still waits."""
        self._unsubscribe()
        self._gather()
        while self._waiting:
            self._forget_next()
        self._drops.tell(all=True)

    def _gather(self) -> None:
        while self._messages:
            message = self._messages.popleft()
            match message.body:
                case {"name": str(name)} if key := name_key(name):
                    if key in self._waiting or len(self._waiting) < MAX_PENDING_NAMES:
                        self._waiting[key] = name
                    else:
                        self._drops.add(message.key, f"{MAX_PENDING_NAMES} names are already waiting to be forgotten")

    def _forget_next(self) -> None:
        name = PersonName(self._waiting.pop(next(iter(self._waiting))))
        for forget in self._forget:
            forget(name)
