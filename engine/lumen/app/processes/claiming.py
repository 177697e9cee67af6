"""There is one robot of a name on a bus, with one brain and one motion module: whoever comes second is refused."""

import time
from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import UsageError
from lumen.language.modules import MODULES
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.runtime.presence import BRAIN, KEY, MOTION, ROBOT, ROUTE, Presence, told

CLAIM = 0.8
"""How long a process asks whether somebody is already what it wants to be [s]."""
ALONE = (ROBOT, BRAIN, MOTION, *MODULES)
"""Of these there is one for each robot; visitors may be many."""
LOOK = 0.02


def presence_of(project: Project, bus: Bus, parts: tuple[str, ...], more: Callable[[], Mapping[str, Any]]) -> Presence:
    """The presence of a process that is these parts, on the project's route."""
    row = project.routes.get(ROUTE)
    return Presence(bus, project.robot, parts, key=row.key_for(project.robot) if row else KEY, more=more)


def refuse(presence: Presence) -> None:
    """Raises UsageError where another process is what this one wants to be."""
    for part in ALONE:
        if part in presence.parts and (rival := presence.rival(part)):
            raise UsageError(
                f"{told(rival)} is the {part} of {presence.robot} on this bus already:"
                " end it first, or give this project's robot another name"
            )


def claim(presence: Presence) -> None:
    """Be everything that a whole exhibition is. Raises UsageError where somebody else is part of it already."""
    end = time.monotonic() + CLAIM
    while time.monotonic() < end:
        presence.tick()
        refuse(presence)
        time.sleep(LOOK)
    presence.settle()
