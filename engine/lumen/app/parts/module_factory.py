"""Makes a module by name, and imports only that one."""

from collections.abc import Callable
from pathlib import Path

from lumen.errors import UsageError
from lumen.feature import owner, table
from lumen.language.projects import Project
from lumen.loading.broken_features import resolved
from lumen.modules.module import Module
from lumen.ports import Bus


def make_module(name: str, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Module:
    """Return a module that has not begun; it keeps its files in `folder`, or none if that is None.

    Raises UsageError if there is no such module, ModuleError if it lacks something that it needs,
    LumenError with the name of the installed package if it can't be imported.
    """
    modules = table("modules")
    if name not in modules:
        raise UsageError(f"no module `{name}`: there are {', '.join(modules)}")
    kind: type[Module] = resolved(owner("modules", name), modules[name].module)
    return kind.make(project, bus, tell, folder)
