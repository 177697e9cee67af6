"""Reports of troubles that modules publish on the bus."""

from collections import deque
from collections.abc import Callable, Sequence

from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, Message
from lumen.run.parts.part import Part

MAX_PENDING_TROUBLES = 100
"""The number of troubles that may wait for a tick; one more drops the oldest."""


class ModuleTroublesPart(Part):
    """The part that prints the troubles of modules in other processes; `own` modules, of this process, print theirs."""

    patient = True

    def __init__(self, project: Project, bus: Bus, tell: Callable[[str, str], None], own: Sequence[str] = ()) -> None:
        self._tell, self._own = tell, own
        self._messages: deque[Message] = deque(maxlen=MAX_PENDING_TROUBLES)
        row = project.routes.get("trouble")
        self._unsubscribe = bus.subscribe(
            row.key_for(project.robot) if row else default_key("trouble", project.robot), self._messages.append
        )

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        while self._messages:
            match self._messages.popleft().body:
                case {"module": str(module), "text": str(text)} if module not in self._own:
                    self._tell(module[:20], text[:500])

    def close(self) -> None:
        self._unsubscribe()
