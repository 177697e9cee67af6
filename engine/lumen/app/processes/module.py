"""A module's process: memory, eyes, ears, voice or social, without knowing who else is there."""

from collections.abc import Callable, Sequence
from pathlib import Path

from lumen.app.modules.factory import make_module
from lumen.buses.validated import ValidatedBus
from lumen.language.events import Event
from lumen.language.projects import Project


class ModulePart:
    """One of the modules; it needs nobody, and hears whoever comes. Raises ModuleError where it can't work here."""

    needs: tuple[str, ...] = ()
    over = failed = False

    def __init__(
        self, name: str, project: Project, bus: ValidatedBus, tell: Callable[[str, str], None], folder: Path
    ) -> None:
        self.name = name
        self._module = make_module(name, project, bus, lambda text: tell(name, text), folder)

    def begin(self, now: float) -> None:
        self._module.begin()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """It works on a thread of its own."""

    def use(self, project: Project) -> None:
        self._module.use(project)

    def interrupt(self) -> bool:
        return False

    def summary(self) -> None:
        print(f"  {self.name}: {self._module.handled} messages")

    def close(self) -> None:
        self._module.close()
