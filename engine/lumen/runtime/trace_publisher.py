"""What the behaviour does, on the bus: for operators, and for visitors in a process of their own."""

import logging
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from lumen.errors import BusError
from lumen.interpreters.statechart import Snapshot, Step
from lumen.interpreters.statechart.nesting import active_names, entered_names
from lumen.language.commands import Command, Log, Publish, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.runtime.loop import Observer

TRACE_ROUTE = "state"
TRACE_TTL = 10.0

_log = logging.getLogger(__name__)


class TracePublisher(Observer):
    """Publishes each step that changed something, each command as it is given, and its answer.

    `project` returns the bundle that runs, `now` for the time [s].
    """

    def __init__(self, bus: Bus, project: Callable[[], Project], now: Callable[[], float]) -> None:
        self._bus, self._project, self._now = bus, project, now
        self._told: tuple[dict[str, Any], str] | None = None

    def stepped(self, step: Step) -> None:
        came, gone, context = list(entered_names(step)), list(step.exited), dict(step.snapshot.context)
        if not came and not gone and (context, step.snapshot.place) == self._told:
            return
        self._told = context, step.snapshot.place
        event = step.event.name if step.event else ""
        self._tell({**_standing(step.snapshot), "entered": came, "exited": gone, "event": event})

    def standing(self, snapshot: Snapshot) -> None:
        """Tell somebody who has just come where the behaviour stands."""
        self._tell(_standing(snapshot))

    def pace(self, realtime: float) -> None:
        """Tell how much of real time is kept, where that has become too little, or enough again."""
        self._tell({"realtime": realtime})

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(id, wanted):
                self._tell({"command": {"verb": type(wanted).__name__.lower(), "id": id, **asdict(wanted)}})
            case Publish(route, body):
                self._tell({"command": {"verb": "publish", "route": route, "body": body}})
            case Log():
                pass

    def answered(self, event: Event) -> None:
        kind, separator, id = event.name.partition(".command.")
        reason = str(event.data.get("reason", "")) if isinstance(event.data, dict) else ""
        if not separator:
            self._tell({"noticed": event.name})
        elif id[:1] in ("c", "d"):
            answer = {"id": id, "kind": kind}
            self._tell({"answer": {**answer, "reason": reason} if reason else answer})

    def _tell(self, what: dict[str, Any]) -> None:
        project = self._project()
        row = project.routes.get(TRACE_ROUTE)
        ttl = row.ttl if row else TRACE_TTL
        key = project.key_of(TRACE_ROUTE)
        try:
            self._bus.publish(key, {"robot": project.robot, "time": round(self._now(), 3), **what}, ttl=ttl)
        except BusError as error:
            _log.debug("what the behaviour does was not published: %s", error)


def _standing(snapshot: Snapshot) -> dict[str, Any]:
    return {"states": sorted(active_names(snapshot)), "context": dict(snapshot.context), "place": snapshot.place}
