"""The modules that run inside `lumen run`, and what those elsewhere say that they can't do."""

from collections import deque
from collections.abc import Callable
from pathlib import Path

from lumen.app.modules.factory import make_module
from lumen.app.node import Node
from lumen.errors import LumenError
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.modules.module import DEFAULT_KEYS, Module
from lumen.ports import Bus, Message

STARVED = 60.0
"""How long a tick waits for the eyes at most [s], where the machine has much else to do."""

Tell = Callable[[str, str], None]
"""Told of a module, and what it says."""


class ModuleTroubles:
    """What modules say on the bus that they can't do, told line by line; `own` say so themselves."""

    def __init__(self, project: Project, bus: Bus, tell: Tell, own: tuple[str, ...] = ()) -> None:
        self._tell, self._own = tell, own
        self._messages: deque[Message] = deque(maxlen=100)
        row = project.routes.get("trouble")
        self.close = bus.subscribe(
            row.key_for(project.robot) if row else DEFAULT_KEYS["trouble"], self._messages.append
        )

    def tick(self, now: float) -> None:
        while self._messages:
            match self._messages.popleft().body:
                case {"module": str(module), "text": str(text)} if module not in self._own:
                    self._tell(module[:20], text[:500])


def join(show: Node, folder: Path | None, tell: Tell, *, paced: bool) -> list[Module]:
    """Let the modules take part that `lumen.yaml` wants here; one that can't is told of, and the others begin.

    Where time is simulated and not `paced`, each tick waits for the eyes: what they see does not depend on the machine.
    """
    project, begun = show.exhibition.project, []
    for name in (name for name, said in project.modules.items() if said.here):
        try:
            module = make_module(name, project, show.bus, lambda text, who=name: tell(who, text), folder)  # type: ignore[misc]
        except LumenError as error:
            tell(name, str(error))
            continue
        module.begin()
        begun.append(module)
        show.using.append(module.use)
        show.closing.insert(0, module.close)
        if name == EYES:
            if show.faces:
                show.faces.quiet = True
            if not paced:
                show.exhibition.parts.append(lambda now, m=module: m.settle(STARVED))  # type: ignore[misc]
    troubles = ModuleTroubles(project, show.bus, tell, tuple(module.name for module in begun))
    show.exhibition.parts.append(troubles.tick)
    show.closing.insert(0, troubles.close)
    return begun
