"""The forgetting of a person in every process, after the memory module has forgotten them, even during their visit."""

import logging
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

from lumen.errors import BusError
from lumen.language.events import Event
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, Message
from lumen.run.parts.part import Part
from lumen.upkeep.drops import DropLog

ROUTE = "forgotten"
MAX_PENDING_NAMES = 100
"""The number of names that may wait; further ones are dropped, which is reported."""
FORGETTING_SPACING = 2.0
"""The time between two names [s]: each is searched for in all files, and many names must not block the process."""

_log = logging.getLogger(__name__)


class ForgettingPart(Part):
    """The part that makes this process forget a person: it calls each function in `forget` with the name.

    Names are handled one at a time, and a name that already waits is not queued again. A request is answered after its
    name was handled, with what `FeatureForgetter.forget` returned; Lumen's own functions return None. The part
    comes before the brain, and has the brain's `needs` if there is a brain.
    """

    patient = True

    def __init__(
        self,
        project: Project,
        bus: Bus,
        *forget: Callable[[PersonName], Mapping[str, str] | None],
        needs: Sequence[str] = (),
    ) -> None:
        self.needs, self._forget, self._bus = needs, forget, bus
        self._messages: deque[Message] = deque(maxlen=MAX_PENDING_NAMES)
        self._waiting: dict[str, tuple[str, Message]] = {}
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
        """Forget the names that still wait."""
        self._unsubscribe()
        self._gather()
        while self._waiting:
            self._forget_next()
        self._drops.tell(all=True)

    def _gather(self) -> None:
        while self._messages:
            message = self._messages.popleft()
            match message.body:
                case {"name": str(name)} if (key := name_key(name)) and (message.reply_to or key not in self._waiting):
                    if key in self._waiting or len(self._waiting) < MAX_PENDING_NAMES:
                        self._waiting[key] = name, message
                    else:
                        self._drops.add(message.key, f"{MAX_PENDING_NAMES} names are already waiting to be forgotten")

    def _forget_next(self) -> None:
        name, message = self._waiting.pop(next(iter(self._waiting)))
        packages: dict[str, str] = {}
        for forget in self._forget:
            packages |= forget(PersonName(name)) or {}
        with suppress(BusError):  # the bus reports that it is gone
            self._bus.reply(message, {"packages": packages})
