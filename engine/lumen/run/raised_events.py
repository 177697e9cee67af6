"""Events that people raise: they are processed like any other, and the sender receives a report on each."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.bus.checking import SchemaCheck
from lumen.insight.explaining.names import machines_in
from lumen.insight.explaining.pressing import pressed, takes
from lumen.language.causes import UNNAMED_PROGRAM, Cause
from lumen.language.controller_events import controller_events
from lumen.language.events import Event, robot_events
from lumen.language.modules import own_module_events
from lumen.language.operator_requests import MAX_NAME, PRESS
from lumen.language.projects import Project
from lumen.language.shared import SHARED_EVENT
from lumen.ports import Message
from lumen.run.loop import BehaviorLoop, Observer
from lumen.statechart import Step


class EventData:
    """Checks event data by the schemas of a project: those under `events:`, of routes, and of robots."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._checks: dict[str, list[tuple[Mapping[str, Any], SchemaCheck]]] = {}

    def wrong(self, name: str, data: Any) -> str:
        """Return in a sentence why an event can't have this data; empty if it can, or if no schema is declared."""
        if name not in self._checks:
            self._checks[name] = [(schema, SchemaCheck(schema)) for schema in _schemas(self.project, name)]
        reasons = [(schema, check(data)) for schema, check in self._checks[name]]
        if not reasons or any(not reason for _, reason in reasons):
            return ""
        schema, reason = reasons[0]
        return f"the data of `{name}` is not as declared: {reason}{_right(schema)}"


def _schemas(project: Project, name: str) -> Iterator[Mapping[str, Any]]:
    """Yield the JSON Schemas of an event's data; several if invoked behaviours declare it too."""
    own = [machine.events[name] for _, machine in machines_in(project.machine) if name in machine.events]
    routed = [project.messages.get(route.schema) for route in project.routes.values() if route.event == name]
    steady = {**controller_events(project.controllers.values()), **own_module_events(project.modules), **robot_events()}
    for schema in own or routed or [steady.get(name)]:
        if isinstance(schema, Mapping):
            yield schema


def _right(schema: Mapping[str, Any]) -> str:
    """Return a sentence that lists the allowed fields and their types; empty if the schema has no fields."""
    fields = schema.get("properties")
    if not isinstance(fields, Mapping) or not fields:
        return ""
    needed = schema.get("required", ())
    told = (f"`{key}`{_type(kind)}{'' if key in needed else ', which may be left out'}" for key, kind in fields.items())
    return f". It has {'; '.join(told)}"


def _type(schema: Any) -> str:
    kind = schema.get("type") if isinstance(schema, Mapping) else None
    return f" ({kind})" if isinstance(kind, str) else ""


_INTERNAL = ("done.", "error.", "cancelled.", "lost.", SHARED_EVENT)
"""The prefixes of the names of robots' internal events, with which an event from a person could be confused."""

Reply = Callable[[Message, Mapping[str, Any]], None]
"""A function that sends a reply to a message."""


def person_in(message: Message) -> str:
    """Return the person that a message names in `by`, else the program that sent it."""
    return str(message.body.get("by") or message.sender or UNNAMED_PROGRAM)[:MAX_NAME]


def refusal(reason: str) -> dict[str, Any]:
    """Return the verdict of a refused request."""
    return {"verdict": "refused", "reason": reason}


class _Raised(NamedTuple):
    message: Message
    cause: Cause


class RaisedEvents(Observer):
    """Raises events on request; `reply` is called with the outcome of each.

    An event is recognised by its cause object, which no other event has.
    """

    def __init__(self, loop: BehaviorLoop, reply: Reply) -> None:
        self._loop, self._reply = loop, reply
        self._open: list[_Raised] = []
        self._data = EventData(loop.project)

    def happen(self, message: Message, now: float) -> None:
        """Raise the event in a message, or of the button that it names, in this tick; or refuse the request."""
        body = message.body
        if body["ask"] == PRESS.ask:
            loop = self._loop
            machine, snapshot = loop.project.machine, loop.runtime.snapshot
            found = pressed(machine, snapshot, body["button"][:MAX_NAME], now, person_in(message))
            if isinstance(found, str):
                self._reply(message, refusal(found))
            else:
                self._let(message, found)
            return
        if (name := body["event"]).startswith(_INTERNAL):
            self._reply(message, refusal(f"`{name}` is an internal event: only robots send it"))
            return
        cause = Cause("person", message.id, sender=person_in(message))
        data = body.get("data")
        self._let(message, Event(name, {} if data is None else data, now, cause=cause))

    def _let(self, message: Message, event: Event) -> None:
        assert event.cause
        if self._data.project is not self._loop.project:
            self._data = EventData(self._loop.project)
        if wrong := self._data.wrong(event.name, event.data):
            self._reply(message, refusal(wrong))
            return
        self._open.append(_Raised(message, event.cause))
        self._loop.happen(event)

    def look(self) -> None:
        """Report the events that had no step: those that wait for approval, and those that were lost."""
        for one in tuple(self._open):
            held = (held for held in self._loop.runtime.approvals.waiting if held.event.cause is one.cause)
            if id := next((held.id for held in held), ""):
                self._open.remove(one)
                self._reply(one.message, {"verdict": "done", "taken": False, "waiting": id})
        if self._open and not self._loop.waiting:
            for one in self._open:
                self._reply(one.message, refusal("the behaviour could not process the event; its log gives the reason"))
            self._open.clear()

    def stepped(self, step: Step) -> None:
        """Report for a raised event whether its step took a transition."""
        for one in self._open:
            if step.event and step.event.cause is one.cause:
                self._open.remove(one)
                self._reply(one.message, {"verdict": "done", "taken": takes(step)})
                return
