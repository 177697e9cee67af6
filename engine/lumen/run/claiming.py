"""The claim of a robot's name: a bus has only one robot of each name, with one brain and one module of each kind.

A process whose robot or part is already there is refused.
"""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.errors import BusUnreachableError, UsageError
from lumen.language.projects import Project
from lumen.ports import BlockableBus, Bus
from lumen.run.presence import PRESENCE_ROUTE, Presence, where_it_runs

CLAIM_DURATION = 0.8
"""The time that a process waits for objections to its claim [s]."""
CLAIM_INTERVAL = 0.02
"""The pause between two checks for objections [s]."""


def presence_of(project: Project, bus: Bus, parts: tuple[str, ...], more: Callable[[], Mapping[str, Any]]) -> Presence:
    """Return the presence of a process with these parts, on the project's route for it."""
    return Presence(bus, project.robot, parts, key=project.key_of(PRESENCE_ROUTE), more=more)


def refuse_rivals(presence: Presence) -> None:
    """Raise UsageError if another process on the bus already has one of this presence's unique parts."""
    for part in presence.claims:
        if rival := presence.rival(part):
            raise UsageError(
                f"{where_it_runs(rival)} is already the {part} of {presence.robot} on this bus:"
                " end it first, or give this project's robot another name"
            )


def refuse_silence(bus: ValidatedBus, presence: Presence) -> None:
    """Raise BusUnreachableError if a rival could not answer because the broker accepts no messages."""
    if (broker := bus.ability(BlockableBus)) and broker.blocked:
        parts = " or ".join(presence.claims)
        raise BusUnreachableError(
            f"the broker is short of {broker.blocked} and accepts no messages, so Lumen can't check whether another"
            f" process is the {parts} of {presence.robot}: start again when"
            " `rabbitmqctl status` no longer shows this alarm"
        )
