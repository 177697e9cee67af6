"""The status of an exhibition in one object, for `lumen status` and other displays."""

from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import Any, NamedTuple

from lumen.language.iso_time import iso_time
from lumen.language.machines import MachineDefinition
from lumen.language.modules import MEMORY, VISITOR_KEY
from lumen.language.projects import Project
from lumen.ports import Battery
from lumen.robot.person_hold import StoppedBy
from lumen.statechart import Snapshot, Timer
from lumen.statechart.nesting import ID_SEPARATOR, active_names


class LastReload(NamedTuple):
    """The last result of a reload."""

    at: datetime
    """When the result was reported (UTC)."""
    verdict: str
    """A verdict of `ReloadReport`."""
    bundle: str
    """The hash of the bundle."""
    text: str
    """The first line of the report for people."""


SKILL_STATES = "skill_states"
"""The field of a presence, and of a status, with the states of the skills that a process performs."""
NOTHING_SAID: Mapping[str, Any] = {}


def status_of(
    project: Project,
    snapshot: Snapshot,
    since: float,
    *,
    battery: object = None,
    stopped: StoppedBy | None = None,
    realtime: float = 1.0,
    reloaded: LastReload | None = None,
    said: Mapping[str, Any] = NOTHING_SAID,
) -> dict[str, Any]:
    """Return the status of an exhibition whose states last changed at `since` [s], as JSON data.

    Times are ISO 8601 in UTC on the exhibition's clock; those of stops and reloads, which people make, are real.
    Unknown values are None: the `visitor` before they give a name, the `battery` and the `ears` of a robot that has
    none. `said` has the state of the `ears`, and of the project's own `modules` and `skills`; the status lacks the
    latter two if there are none. The skills that another process performs are in the presence of that process.
    """
    return {
        "robot": project.robot,
        "configuration": sorted(active_names(snapshot)),
        "since": _time(snapshot, since),
        "language": snapshot.language,
        "visitor": _visitor(project, snapshot),
        "battery": battery.percentage if isinstance(battery, Battery) else None,
        "ears": said.get("ears"),
        "timers": [
            {"event": event, "due": _time(snapshot, due)} for due, event in sorted(_timers(project.machine, snapshot))
        ],
        "stopped": stopped is not None,
        "stopped_by": stopped.by if stopped else None,
        "realtime": realtime,
        "bundle": project.hash,
        "last_reload": _reload(reloaded) if reloaded else None,
        **({"modules": [*modules]} if (modules := said.get("modules")) else {}),
        **({SKILL_STATES: dict(skills)} if (skills := said.get("skills")) else {}),
    }


def _time(snapshot: Snapshot, at: float) -> str:
    return iso_time(snapshot.epoch + at)


def _visitor(project: Project, snapshot: Snapshot) -> str | None:
    """Return the visitor's name, or None, from the key of the context that the memory module also uses."""
    memory = project.modules.get(MEMORY)
    name = snapshot.context.get(str(memory.options.get("visitor", VISITOR_KEY)) if memory else VISITOR_KEY)
    return name if isinstance(name, str) and name else None


def _timers(machine: MachineDefinition, snapshot: Snapshot, prefix: str = "") -> Iterator[tuple[float, str]]:
    for timer in snapshot.timers:
        yield timer.due, prefix + _event(machine, timer)
    for id, child in snapshot.invoked.items():
        inner = machine.invoked[machine.invoked_behavior(child.state, id)]
        yield from _timers(inner, child.snapshot, f"{prefix}{id}{ID_SEPARATOR}")


def _event(machine: MachineDefinition, timer: Timer) -> str:
    """Return a timer in words: `after 30 s in greet`, `wait in sing`; for a `send` the event's name."""
    if timer.kind == "send":
        return timer.event
    state = machine.states[timer.state]
    waited = next((t.awaited_time for t in state.transitions if t.timed and t.event == timer.event), timer.kind)
    return f"{waited} in {state.name or machine.id}"


def _reload(reloaded: LastReload) -> dict[str, Any]:
    return {**reloaded._asdict(), "at": iso_time(reloaded.at.timestamp())}
