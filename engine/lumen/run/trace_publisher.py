"""The behaviour's trace on the bus, for operators and for visitors in other processes."""

import logging
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from lumen.errors import BusError
from lumen.insight.migration import MigrationPlan
from lumen.language.causes import Cause
from lumen.language.command_data import trace_verb, traced
from lumen.language.commands import Command, Start
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.run.approvals import HeldEvent
from lumen.run.loop import Observer
from lumen.run.troubles import RunTrouble
from lumen.statechart import Snapshot, Step
from lumen.statechart.nesting import active_names, entered_names, flattened_steps

TRACE_ROUTE = "state"
TRACE_TTL = 10.0
"""The default time to live of a message [s]."""
MAX_DATA_CHARACTERS = 10_000
"""The greatest length of an event's data that is published [characters]."""

_log = logging.getLogger(__name__)


class TracePublisher(Observer):
    """A publisher of each step that changed something, each command and its answer, and the events that wait for GO.

    `project` returns the bundle that runs, `now` the time [s], `count` the number of steps so far, `emitting` the
    number of the step that issued the present command (0 if unknown), and `waiting` the events that wait for GO.
    """

    def __init__(
        self,
        bus: Bus,
        project: Callable[[], Project],
        now: Callable[[], float],
        count: Callable[[], int] = lambda: 0,
        emitting: Callable[[], int] = lambda: 0,
        waiting: Callable[[], Iterable[HeldEvent]] = tuple,
    ) -> None:
        self._bus, self._project, self._now = bus, project, now
        self._count, self._emitting, self._waiting = count, emitting, waiting
        self._told: tuple[dict[str, Any], str] | None = None

    def stepped(self, step: Step) -> None:
        came, gone, context = list(entered_names(step)), list(step.exited), dict(step.snapshot.context)
        if not came and not gone and (context, step.snapshot.place) == self._told:
            return
        self._told = context, step.snapshot.place
        project = self._project()
        body = {**_standing(step.snapshot), "entered": came, "exited": gone, "event": ""}
        if step.event:
            body |= {"event": step.event.name, "cause": _cause(step.event.cause)}
        taken = list(_transitions(project, step))
        self._tell({**body, "step": self._count(), "transitions": taken, "bundle": project.hash, "data": _data(step)})

    def migrated(self, plan: MigrationPlan) -> None:
        """Publish the state after a reload, with the states left and entered."""
        project = self._project()
        cause = Cause("file", f"behaviors/{project.behavior}.yaml")
        ways = {"entered": list(plan.entered), "exited": list(plan.exited), "event": "", "cause": _cause(cause)}
        self._tell({**_standing(plan.snapshot), **ways, "step": self._count(), "bundle": project.hash})

    def standing(self, snapshot: Snapshot) -> None:
        """Publish the present state and the events that wait for GO, for a process that has just joined."""
        self._tell(_standing(snapshot))
        for held in self._waiting():
            self.approval("waits", held, "")

    def approval(self, became: str, held: HeldEvent, why: str) -> None:
        """Publish that an event for a marked transition waits, was released or was dropped, and why.

        `became` is `waits`, `goes` or `stays`.
        """
        project, (machine, wanted, approval) = self._project(), held.marked
        place = project.place(_file(project, machine), wanted.where)
        said: dict[str, Any] = {
            "id": held.id,
            "event": held.event.name,
            "became": became,
            "why": why,
            "source": wanted.source,
        }
        said |= {"targets": list(wanted.targets), "file": place.file, "line": place.line}
        until = None if approval.within is None else round(held.until, 3)
        self._tell({"approval": {**said, "since": round(held.since, 3), "until": until, "else": approval.otherwise}})

    def pace(self, realtime: float) -> None:
        """Publish the share of real time, when it becomes too low or recovers."""
        self._tell({"realtime": realtime})

    def performing(self, command: Command, now: float) -> None:
        if said := traced(command):
            self._tell({"command": said, "step": self._emitting()})

    def refused(self, command: Start, reason: str) -> None:
        said = {"verb": trace_verb(command.command), "id": command.id, "reason": reason}
        self._tell({"refused": said, "step": self._emitting()})

    def answered(self, event: Event) -> None:
        kind, separator, id = event.name.partition(".command.")
        reason = str(event.data.get("reason", "")) if isinstance(event.data, dict) else ""
        if not separator:
            self._tell({"noticed": event.name})
        elif id[:1] in ("c", "d"):
            answer = {"id": id, "kind": kind}
            self._tell({"answer": {**answer, "reason": reason} if reason else answer})

    def troubled(self, trouble: RunTrouble) -> None:
        self._tell({"trouble": trouble._asdict()})

    def _tell(self, what: dict[str, Any]) -> None:
        project = self._project()
        row = project.routes.get(TRACE_ROUTE)
        ttl = row.ttl if row else TRACE_TTL
        key = project.key_of(TRACE_ROUTE)
        try:
            self._bus.publish(key, {"robot": project.robot, "time": round(self._now(), 3), **what}, ttl=ttl)
        except BusError as error:
            _log.debug("the trace of the behaviour was not published: %s", error)


def _transitions(project: Project, step: Step) -> Iterator[dict[str, Any]]:
    """Yield the transitions that were taken, also in invoked behaviours, with their places."""
    for prefix, machine, part in flattened_steps(project.machine, step):
        file = _file(project, machine)
        for transition in part.transitions:
            place = project.place(file, transition.where)
            said = {"source": prefix + transition.source, "targets": [prefix + target for target in transition.targets]}
            yield {**said, "file": place.file, "line": place.line}


def _file(project: Project, machine: MachineDefinition) -> str:
    """Return the file of a machine; with a story's context the machine is another object than the one read."""
    names = {id(one): name for name, one in project.behaviors.items()} | {id(project.machine): project.behavior}
    return f"behaviors/{names.get(id(machine), machine.id)}.yaml"


def _cause(cause: Cause | None) -> dict[str, Any]:
    """Return the known fields of an event's cause."""
    return {key: value for key, value in cause._asdict().items() if value} if cause else {}


def _data(step: Step) -> Any:
    """Return the event's data; None if it is too long."""
    data = step.event.data if step.event else None
    return data if len(repr(data)) <= MAX_DATA_CHARACTERS else None


def _standing(snapshot: Snapshot) -> dict[str, Any]:
    return {"states": sorted(active_names(snapshot)), "context": dict(snapshot.context), "place": snapshot.place}
