"""A module of an exhibition, such as the memory or the eyes, independent of the other parts."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from lumen.errors import LumenError, UsageError
from lumen.feature import owner, table
from lumen.language.counts import counted
from lumen.language.diagnostics import Diagnostic
from lumen.language.events import Event
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.project.broken_features import blaming, faults_reported, faulty, resolved, shown
from lumen.run.claiming import presence_of
from lumen.run.module import Module
from lumen.run.parts.part import Part
from lumen.run.presence import Presence


def make_module(name: str, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Module:
    """Return a module that has not begun, with its files in `folder` (None: no files).

    Raises UsageError if there is no such module, ModuleError if a requirement of the module is missing, LumenError with
    the name of the installed package if the package's code is faulty.
    """
    modules = table("modules")
    if name not in modules:
        raise UsageError(f"no module `{name}`: there are {', '.join(modules)}")
    feature, where = owner("modules", name), modules[name].module
    kind = resolved(feature, where)
    if not (isinstance(kind, type) and issubclass(kind, Module)):
        raise faulty(feature, f"its module `{where}` is no subclass of `lumen.run.module.Module`")
    with blaming(feature, where, LumenError):
        made = kind.make(project, bus, tell, folder)
    if not isinstance(made, Module):
        raise faulty(feature, f"`{where}.make` returned {shown(made)} instead of a module")
    return made


EYES_TIMEOUT = 60.0
"""The longest wait of a tick for the eyes on a busy machine [s]."""
OWN_OPTIONS = ("camera", "window", "robots")
"""Options of the eyes that apply only to the project's own robot."""


class ModulePart(Part):
    """A module on a thread of its own; it needs no other part, and handles messages from any sender.

    With `awaited` each tick waits for the eyes, so that their sightings do not depend on the machine's speed. Eyes may
    serve several robots (`Project.served`): then there is one module for each, visible to that robot's exhibition.
    Faces learned for another robot are lost with the process. Raises ModuleError if the module can't work here.
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
        self._tell = tell
        self._modules = {project.robot: make_module(name, project, bus, lambda text: tell(name, text), folder)}
        self._presences: list[Presence] = []
        for robot in project.served[1:] if name == EYES else ():
            other = _of_another(project, robot)
            self._modules[robot] = make_module(name, other, bus, lambda text: tell(name, text), None)
            self._presences.append(presence_of(other, bus, (name,), dict))
        self._awaited = awaited and name == EYES
        self.patient = not self._awaited

    def begin(self, now: float) -> None:
        for robot, module in tuple(self._modules.items()):
            if not self._done(module.begin):
                del self._modules[robot]
        for presence in self._presences:
            presence.settle()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        for presence in self._presences:
            presence.tick()
        if self._awaited:
            for module in self._modules.values():
                module.settle(EYES_TIMEOUT)

    def use(self, project: Project) -> None:
        """Switch to a bundle; the set of served robots is fixed at the start."""
        own = next(iter(self._modules), "")
        for robot, module in self._modules.items():
            self._done(partial(module.use, project if robot == own else _of_another(project, robot)))

    def summary(self) -> Iterator[str]:
        lines: list[str] = []
        for robot, module in self._modules.items():
            what = self.name if len(self._modules) == 1 else f"{self.name} of {robot}"
            self._done(partial(_add_count, lines, what, module))
        yield from lines

    def close(self) -> None:
        for module in self._modules.values():
            for close in dict.fromkeys((type(module).close, Module.close)):  # the thread ends even if the first fails
                self._done(partial(close, module))
        for presence in self._presences:
            presence.close()

    def _done(self, call: Callable[[], None]) -> bool:
        """Call a method of a module; report a fault of another package's code, and return False if there was one."""
        faults: list[Diagnostic] = []
        with faults_reported(owner("modules", self.name), f"its module `{self.name}`", faults.append):
            call()
        for fault in faults:
            self._tell(self.name, f"{fault.message} ({fault.hint})")
        return not faults


def _add_count(lines: list[str], what: str, module: Module) -> None:
    dropped = f", {module.refused} dropped" if module.refused else ""
    lines.append(f"{what}: {counted(module.handled, 'message')}{dropped}")


def _of_another(project: Project, robot: str) -> Project:
    """Return the project with another robot, whose eyes use that robot's own camera and show no window here."""
    settings = project.modules[EYES]
    options = {key: value for key, value in settings.options.items() if key not in OWN_OPTIONS}
    return replace(project, robot=robot, modules={**project.modules, EYES: replace(settings, options=options)})
