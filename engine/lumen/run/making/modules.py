"""Makers of Lumen's own modules, in the process of an exhibition or in separate ones."""

from dataclasses import dataclass
from pathlib import Path

from lumen.bus.addresses import within_process
from lumen.errors import LumenError
from lumen.language.modules import EYES, module_names
from lumen.language.modules import own_modules as own_modules_of
from lumen.run.live_behavior import LiveBehavior
from lumen.run.parts.module import ModulePart
from lumen.run.parts.module_troubles import ModuleTroublesPart
from lumen.run.parts.own_module import OwnModulePart
from lumen.run.parts.part import Part
from lumen.run.parts.robot import RobotPart
from lumen.run.presence import BRAIN, MOTION, ROBOT_PART, host_of
from lumen.run.services import Services


@dataclass(frozen=True, slots=True)
class ModulesPlan:
    """The way in which modules take part."""

    folder: Path | None = None
    """The folder for their files; None if nothing may be saved."""
    awaited: bool = False
    """Whether each tick waits for the eyes, so that their faces do not depend on the machine's speed."""


def modules(services: Services) -> list[Part]:
    """Make the modules that `lumen.yaml` places in this process, or those of the process's roles."""
    here = [name for name, said in services.project.modules.items() if said.here and not said.own]
    wanted = [role for role in services.plan.roles if role in module_names()] if services.plan.roles else here
    begun = [part for name in wanted if (part := _module(services, name))]
    if not services.plan.roles:
        _share(services, [part.name for part in begun])
    return begun


def own_modules(services: Services) -> list[OwnModulePart]:
    """Make the parts that watch the project's own programs.

    The brain's process watches all programs, another process those that it starts. A story has no such parts.
    """
    plan = services.plan
    names = [name for name in own_modules_of(services.project.modules) if plan.brain or name in plan.roles]
    return [] if plan.story is not None else [_own_module(services, name) for name in names]


def troubles(services: Services) -> ModuleTroublesPart:
    """Make the part that prints the troubles of modules in other processes."""
    own = [part.name for part in services.node.parts if isinstance(part, ModulePart)]
    return ModuleTroublesPart(services.project, services.bus, services.narrator.line, own)


def _own_module(services: Services, name: str) -> OwnModulePart:
    url = "" if within_process(services.plan.url) else services.plan.url
    behavior = services.get(LiveBehavior)
    return OwnModulePart(
        name,
        services.project,
        services.bus,
        services.narrator.line,
        behavior.loop.happen if behavior else lambda event: None,
        bus_url=url,
        starts=name in services.plan.roles,
    )


def _module(services: Services, name: str) -> Part | None:
    """Return a module; None if it can't work, which is reported.

    Raises LumenError instead if running modules is the role of this process.
    """
    how: ModulesPlan = services.plan.options["modules"]
    tell = services.narrator.line
    try:
        return ModulePart(name, services.project, services.bus, tell, how.folder, awaited=how.awaited)
    except LumenError as error:
        if services.plan.roles:
            raise
        tell(name, str(error))
        return None


def _share(services: Services, names: list[str]) -> None:
    """Announce the modules of this process; if the eyes are among them, the robot does not report faces."""
    faces = services[RobotPart].faces
    if faces and EYES in names:
        faces.quiet = True
    if services.presence:
        hosts = [part for part in services.presence.parts if part in map(host_of, services.project.modules)]
        services.presence.parts = (ROBOT_PART, BRAIN, MOTION, *names, *hosts)
