"""A module by its name; what it needs is imported only then."""

from collections.abc import Callable
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.modules import ANSWERS, EARS, EYES, MEMORY, MODULES, SHOW, SOCIAL, VOICE
from lumen.language.projects import Project
from lumen.modules.module import Module
from lumen.ports import Bus


def make_module(name: str, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Module:
    """The module of that name, not yet begun; what it keeps is in `folder`, None for nothing that lasts.

    Raises UsageError where there is no such module, ModuleError where it lacks what it works with.
    """
    if name == MEMORY:
        from lumen.modules.memory import Memory
        from lumen.modules.memory.memory import DATABASE_FILE

        return Memory(project, bus, tell, folder and folder / DATABASE_FILE)
    if name == EYES:
        from lumen.modules.eyes import Eyes
        from lumen.modules.eyes.eyes import FACES_FILE

        return Eyes(project, bus, tell, folder and folder / FACES_FILE)
    if name == VOICE:
        from lumen.modules.voice import Voice

        return Voice(project, bus, tell)
    if name == EARS:
        from lumen.modules.ears import Ears

        return Ears(project, bus, tell)
    if name == SOCIAL:
        from lumen.modules.social import POSTS_FILE, Social

        return Social(project, bus, tell, folder and folder / POSTS_FILE)
    if name == SHOW:
        from lumen.modules.show import ShowControl

        return ShowControl(project, bus, tell)
    if name == ANSWERS:
        from lumen.modules.answers import Answers

        return Answers(project, bus, tell)
    raise UsageError(f"no module `{name}`: there are {', '.join(MODULES)}")
