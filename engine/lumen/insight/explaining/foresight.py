"""The commands that a robot would receive if an event were processed now."""

from collections import deque
from typing import Any

from lumen.errors import LumenError
from lumen.language.command_data import traced
from lumen.language.commands import Start
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.statechart.stepping import step
from lumen.statechart.values import Snapshot

MAX_DEEDS = 8
"""The maximum number of commands that are listed."""


def foreseen(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> list[dict[str, Any]]:
    """Return the commands that an event would cause, in order: `{"verb": "say", "text": "Hello", …}`.

    It assumes that each command ends as usual, and that nothing else happens. The list ends at the next transition,
    after `MAX_DEEDS`, or if the step raises a LumenError.
    """
    found: list[dict[str, Any]] = []
    left, entered = deque([event._replace(at=max(event.at, snapshot.at))]), False
    while left and len(found) < MAX_DEEDS:
        try:
            taken = step(machine, snapshot, left.popleft())
        except LumenError:
            break
        if entered and taken.transitions:
            break
        snapshot, entered = taken.snapshot, True
        for command in taken.commands:
            if said := traced(command):
                found.append({key: value for key, value in said.items() if key not in ("id", "body")})
            if isinstance(command, Start):
                left.append(Event(f"done.command.{command.id}", {}, snapshot.at))
    return found[:MAX_DEEDS]
