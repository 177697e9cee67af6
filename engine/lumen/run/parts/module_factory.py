"""Makes a module by name, and imports only that one."""

from collections.abc import Callable
from pathlib import Path

from lumen.errors import LumenError, UsageError
from lumen.feature import owner, table
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.project.broken_features import blaming, faulty, resolved, shown
from lumen.run.module import Module


def make_module(name: str, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Module:
    """Return a module that has not begun; it keeps its files in `folder`, or none if that is None.

    Raises UsageError if there is no such module, ModuleError if it lacks something that it needs,
    LumenError with the name of the installed package if its code is faulty.
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
