"""Makes a module by name, and imports only that one."""

from collections.abc import Callable
from pathlib import Path

from lumen.errors import UsageError
from lumen.feature import resolve, table
from lumen.language.projects import Project
from lumen.modules.module import Module
from lumen.ports import Bus


def make_module(name: str, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Module:
    """Return a module that has not begun; it keeps its files in `folder`, or none if that is None.

    Raises UsageError if there is no such module, ModuleError if it lacks something that it needs.
    """
    modules = table("modules")
    if name not in modules:
        raise UsageError(f"no module `{name}`: there are {', '.join(modules)}")
    kind: type[Module] = resolve(modules[name].module)
    return kind.make(project, bus, tell, folder)
