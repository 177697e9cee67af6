"""A module of an exhibition: memory, eyes, ears, voice, social or show, without knowing who else is there."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from lumen.app.parts.module_factory import make_module
from lumen.app.parts.part import Part
from lumen.language.events import Event
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.ports import Bus

EYES_TIMEOUT = 60.0
"""How long a tick waits for the eyes at most [s], where the machine has much else to do."""


class ModulePart(Part):
    """One of the modules, on a thread of its own; it needs nobody, and hears whoever comes.

    Where it is `awaited` each tick waits for the eyes: what they see does not depend on the machine. Raises
    ModuleError where it can't work here.
    """

    def __init__(
        self,
        name: str,
        project: Project,
        bus: Bus,
        tell: Callable[[str, str], None],
        folder: Path | None,
        *,
        awaited: bool = False,
    ) -> None:
        self.name = name
        self._module = make_module(name, project, bus, lambda text: tell(name, text), folder)
        self._awaited = awaited and name == EYES

    def begin(self, now: float) -> None:
        self._module.begin()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        if self._awaited:
            self._module.settle(EYES_TIMEOUT)

    def use(self, project: Project) -> None:
        self._module.use(project)

    def summary(self) -> Iterator[str]:
        refused = f", {self._module.refused} dropped" if self._module.refused else ""
        yield f"{self.name}: {self._module.handled} messages{refused}"

    def close(self) -> None:
        self._module.close()
