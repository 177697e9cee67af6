"""The effect that a question is about, and the links of the chain from the effect to its cause."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from lumen.errors import UsageError
from lumen.insight.explaining.history import RecordedStep, StepHistory
from lumen.insight.explaining.names import KnownNames, same_text, state_named
from lumen.insight.explaining.words import of_command
from lumen.language.causes import Cause
from lumen.language.commands import Command, Publish, Say, Start, Tell
from lumen.language.diagnostics import Place
from lumen.language.events import Event, robot_events
from lumen.language.iso_time import iso_time
from lumen.language.modules import own_module_events
from lumen.statechart.nesting import entered_names

LinkKind = Literal["command", "activity", "transition", "event", "timer", "message", "person", "file", "start"]


@dataclass(frozen=True, slots=True)
class Link:
    """A link in a chain of causes: an event, a command or another occurrence."""

    kind: LinkKind
    """The kind of occurrence."""
    text: str
    """The event, command or other occurrence, in words."""
    at: float
    """The time of the occurrence [s since 1970, in UTC]."""
    place: Place | None = None
    """The place in the files that defines the occurrence; None if no file does."""
    id: str = ""
    """The id of the command, timer or message; empty without an id."""
    values: Mapping[str, Any] = field(default_factory=dict)
    """The values that decided the occurrence: those of the guard's parts, or the data of the event."""
    number: int = 0
    """The number of the recorded step."""

    def to_json(self) -> dict[str, Any]:
        """Return an entry of `chain` in the output of `lumen why --format json`."""
        return {
            "kind": self.kind,
            "text": self.text,
            "at": iso_time(self.at),
            "file": self.place.file if self.place else None,
            "line": self.place.line if self.place else None,
            "id": self.id,
            "values": dict(self.values),
        }


class Effect(NamedTuple):
    """An effect in a step: a command, or the entry of a state."""

    number: int
    """The number of the step."""
    what: str
    """The effect in words."""
    command: Command | None = None
    """The command; None if the effect is a state."""
    state: str = ""
    """The outside name of the state that was entered; empty if the effect is a command."""


def effect(history: StepHistory, what: str) -> Effect:
    """Return the last effect that `what` names; if `what` is empty, the last effect of all.

    Raises UsageError, with a hint, if the history does not contain it.
    """
    if not history.steps:
        raise UsageError("the journal has no entries from that time: choose another time with `--at`")
    found = next(_effects(history, what), None)
    if found is None:
        raise UsageError(_unknown(history, what))
    return found


def _effects(history: StepHistory, what: str) -> Iterator[Effect]:
    """Yield the matching effects, newest first."""
    state = state_named(history.steps[-1].machine, what) if what else ""
    for number in reversed(range(len(history.steps))):
        step = history.steps[number].step
        if state and state in entered_names(step):
            yield Effect(number, f"in {state}", state=state)
        for command in reversed(step.commands):
            if is_meant(command, what):
                yield Effect(number, of_command(command), command)
        if not what and not step.commands and (entered := list(entered_names(step))):
            yield Effect(number, f"in {entered[-1]}", state=entered[-1])


def is_meant(command: Command, what: str) -> bool:
    """Return whether `what` means a command: its id, part of its text, or a name in it; empty means any command."""
    match command:
        case Start(id, wanted):
            if not what or what == id:
                return True
            if isinstance(wanted, Say):
                return same_text(what, wanted.text)
            return what in (getattr(wanted, name) for name in wanted.__dataclass_fields__)
        case Publish(route):
            return what in ("", route)
        case Tell(_, event):
            return what in ("", event)
    return False


def _unknown(history: StepHistory, what: str) -> str:
    """Return the message for a question that has no answer, with a hint."""
    known = KnownNames(history.steps[-1])
    first = history.steps[0]
    kept = f"in the {history.steps[-1].at - first.at:.0f} s that the journal covers"
    if not what:
        return f"nothing happened {kept}"
    if known.has(what):
        return f"`{what}` did not happen {kept}: run `lumen why-not {what}`, or choose another time with `--at`"
    said = [of_command(c) for one in history.steps for c in one.step.commands if isinstance(c, Start)]
    hint = known.near(what)
    return f"nothing named `{what}` happened {kept}, and no text contains these words" + (
        f": {hint}" if hint else f"; the robot's last action: it {said[-1]}" if said else ""
    )


class EventOrigin(NamedTuple):
    """The cause of an event, which is the last link of a chain."""

    kind: LinkKind
    text: str
    id: str = ""
    values: Mapping[str, Any] = {}


def origin(one: RecordedStep, event: Event) -> EventOrigin | None:
    """Return the cause of an event from its data, or from the table of routes; None if the cause is unknown."""
    if event.cause and (said := _said(event.cause)):
        return said
    by = event.data.get("by") if isinstance(event.data, Mapping) else None
    if event.name in ("stop", "resume") and by:
        return EventOrigin("person", f"{by} requested it")
    project = one.project
    rows = [row for row in project.routes.values() if row.event == event.name] if project else []
    if project and rows:
        key = rows[0].key_for(project.robot)
        return EventOrigin("message", f"a message on {key}", "", {"key": key})
    if event.name in robot_events():
        return EventOrigin("event", "the robot detected it")
    if project and event.name in own_module_events(project.modules):
        return EventOrigin("event", "the exhibition watches this module")
    return None


def _said(cause: Cause) -> EventOrigin | None:
    """Return the cause given in the event itself; None for other kinds of causes."""
    values = {key: value for key in ("key", "sender") if (value := getattr(cause, key))}
    by = f", from {cause.sender}" if cause.sender else ""
    match cause.kind:
        case "message":
            return EventOrigin("message", f"a message on {cause.key}{by}", cause.id, values)
        case "person":
            said = f"{cause.sender or 'somebody'}" + (f", by a message on {cause.key}" if cause.key else "")
            return EventOrigin("person", said, cause.id, values)
        case "file":
            return EventOrigin("file", f"the file {cause.id}", cause.id, values)
        case "start":
            return EventOrigin("start", "the run began")
        case "robot":
            return EventOrigin("event", f"the robot detected it{by}", cause.id, values)
    return None
