"""Events: which behaviours and routes raise them, and which transitions wait for them."""

from collections.abc import Iterator, Mapping, Set
from typing import Any

from lumen.language.actions import Assign, CancelSend, LogText, PlacedAction, PublishBody, Raise, Send
from lumen.language.added_verbs import added_row, result_schema
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.commands import Do
from lumen.language.controller_events import controller_events
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean, nearest
from lumen.language.events import robot_events
from lumen.language.json_paths import values_in
from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.language.modules import own_module_events
from lumen.lint.endings import ending_fault
from lumen.lint.lookups import first
from lumen.lint.recipients import recipients, sent_to
from lumen.lint.walk import action_sites
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import Same, memoize
from lumen.project.settings import Settings

UNKNOWN_EVENT = Code("unknown-event", "references", ERROR, "a behaviour waits for an event that nothing raises")
UNUSED_EVENT = Code("unused-event", "statecharts", WARNING, "an event is raised or declared, but nothing waits for it")
PART_EVENT = Code("part-event", "references", WARNING, "an event has the name of a part that can be lost and come back")


BUILT_IN_FAMILIES = (
    "done.state.", "done.do.", "done.invoke.", "done.command.", "error.do.", "error.invoke.", "error.command.",
    "cancelled.command.", "error.execution", "error.communication",
)  # fmt: skip
"""Events that the engine itself raises, or the beginnings of their names."""

_INSTANT = (Assign, CancelSend, LogText, PublishBody, Raise, Send)
"""Actions that a `do` does not wait for."""

_REASON = {"type": "object", "properties": {"reason": {"type": "string"}}, "required": ["reason"]}


def check(draft: ProjectDraft) -> None:
    """Report events that are awaited but never raised, raised but never awaited, or named like a part of the robot."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        _waited(draft, machine, report)
        _named_like_parts(draft, machine, report)
        if report.whole:
            _raised(draft, name, report)


def hears(descriptor: str, event: str) -> bool:
    """Return whether a descriptor of `on` matches an event: exactly, as a prefix of words, or as `*` (SCXML 3.12.1)."""
    prefix = descriptor.removesuffix(".*")
    return descriptor == "*" or event == prefix or event.startswith(f"{prefix}.")


def descriptors(machine: MachineDefinition) -> tuple[str, ...]:
    """Return the descriptors under `on` in the whole machine, each once."""
    found = (t.event for state in machine.states.values() for t in state.transitions if t.event and not t.exact)
    return memoize(("descriptors", machine.id), Same(machine), lambda: tuple(dict.fromkeys(found)))


def declared(draft: ProjectDraft, machine: MachineDefinition) -> dict[str, Any]:
    """Return the events that can arrive from outside this machine, with the JSON Schemas of their data.

    The schema is None if the data can be anything.
    """
    found: dict[str, Any] = {}
    routes = draft.settings.routes.values() if draft.settings else ()
    for route in routes:
        if route.event:
            schema = draft.messages.get(route.schema)
            found[route.event] = schema if found.get(route.event, schema) == schema else None
    pressed = {b.event: None for other in draft.behaviors.values() for s in other.states.values() for b in s.buttons}
    modules = own_module_events(draft.settings.modules) if draft.settings else {}
    steady = {**controller_events(draft.controllers.values()), **robot_events(), **modules}
    return {**pressed, **steady, **found, **machine.events}


def outcome(machine: MachineDefinition, transition: Transition) -> dict[str, Any] | None:
    """Return the event of an `onDone` or `onError` of an invoke, with the schema of its data; else None.

    The `onDone` of a `do` counts as well if the last action of the `do` has a result. The schema is None if the data
    can be anything.
    """
    state = machine.states[transition.source]
    if transition.event == f"done.do.{state.name}" and (result := _result(state.do)):
        return {transition.event: result}
    for invoke in state.invoke:
        if transition.event == f"error.invoke.{invoke.id}":
            return {transition.event: _REASON}
        if transition.event == f"done.invoke.{invoke.id}":
            other = machine.invoked.get(invoke.behavior)
            return {transition.event: _output(other) if other else None}
    return None


def _result(block: tuple[PlacedAction, ...]) -> Mapping[str, Any] | None:
    """Return the JSON Schema of the result of a block's last action that takes time; None if it has no result."""
    last = next((step.action for step in reversed(block) if not isinstance(step.action, _INSTANT)), None)
    row = added_row(last) if isinstance(last, Do) else None
    return result_schema(row) if row and row.result else None


def _output(machine: MachineDefinition) -> Mapping[str, Any] | None:
    """Return the JSON Schema of a machine's output at its end; None if some end has no map as output."""
    states = [machine.states[path] for path in machine.root.children]
    outputs = [state.output for state in states if state.kind is StateKind.FINAL]
    maps = [output for output in outputs if isinstance(output, Mapping)]
    if not maps or len(maps) < len(outputs):
        return None
    properties: dict[str, Any] = {key: {} for output in maps for key in output}
    required = [key for key in properties if all(key in output for output in maps)]
    return {"type": "object", "properties": properties, "required": required}


def raised(document: Document) -> tuple[str, ...]:
    """Return the names of all events that a behaviour raises, or sends to itself; broken actions count as well."""
    data = document.data
    return memoize(("raised", document.file), Same(data), lambda: tuple(dict.fromkeys(_raises(data))))


def _raises(data: Any) -> Iterator[str]:
    for item in values_in(data):
        if isinstance(item, Mapping):
            for body in (item.get("raise"), item.get("send")):
                name = body.get("event") if isinstance(body, Mapping) and "to" not in body else body
                if isinstance(name, str):
                    yield name


def _waited(draft: ProjectDraft, machine: MachineDefinition, report: DocumentReport) -> None:
    if draft.settings is None or draft.main is None:
        return
    known = {
        *declared(draft, machine),
        *raised(report.document),
        *sent_to(draft, machine),
        *draft.main.lost,
        *report.lost,
    }
    prefixes = {prefix for name in known for prefix in _prefixes(name)}
    heard = {e for e in descriptors(machine) if (known if e == "*" else e.removesuffix(".*") in prefixes)}
    misspelt = _Misspelt(machine)
    said: set[str] = set()
    sound = not report.diagnostics
    for state in machine.states.values():
        for transition in state.transitions:
            event = transition.event
            if not event or transition.exact or event in said or event in heard:
                continue
            said.add(event)
            report.missed.add(event)
            if report.whole and _misnamed(event, misspelt, report):
                continue
            if _of_the_engine(event):
                if sound and not report.lost.intersection(event.split(".")) and (hint := ending_fault(machine, event)):
                    path, message = descriptor_path(transition), f"nothing raises the event `{event}`"
                    report(UNKNOWN_EVENT, path, message, hint, key=True)
            else:
                path = descriptor_path(transition)
                hint = _hint(draft.settings, event, known, draft.main.lost | report.lost)
                message = f"nothing raises the event `{event}`"
                if transition.hears:
                    path, message = path[:-1], f"`hears` waits for the event `{event}`, which nothing raises"
                report(UNKNOWN_EVENT, path, message, hint, key=True, cause=f"name {event}")


def _named_like_parts(draft: ProjectDraft, machine: MachineDefinition, report: DocumentReport) -> None:
    """Report each event whose transition also reacts to the loss and return of the part with the same name."""
    own = {*declared(draft, machine), *raised(report.document), *sent_to(draft, machine)}
    named = {event for event in own if f"{event}.lost" in robot_events()}
    for transition in (t for state in machine.states.values() for t in state.transitions):
        if transition.event in named and not transition.exact:
            event = transition.event
            message = f"`{event}` also reacts to `{event}.lost` and `{event}.back`, the events of the part `{event}`"
            hint = f"give your event another name, such as `{event}.said`"
            report(PART_EVENT, descriptor_path(transition), message, hint, key=True)


def _hint(settings: Settings, event: str, known: Set[str], lost: Set[str]) -> str:
    """Return the hint for an event that nothing raises; names in `lost`, which could not be read, are not suggested."""
    built_in = {route.event: name for name, route in BUILT_IN_ROUTES.items() if route.event}
    if (name := built_in.get(event.removesuffix(".*"))) in settings.removed_routes:
        return f"delete the row `{name}: null` in lumen.yaml, or declare the event under `events:`"
    families = (family.removesuffix(".") for family in BUILT_IN_FAMILIES)
    hint = did_you_mean(event, {*known, *built_in, *families} - {event} - lost)
    return hint if "mean" in hint else "declare it under `events:`, or write it as the `event` of a route in lumen.yaml"


def _prefixes(event: str) -> list[str]:
    """Return the event and its dotted prefixes, the shortest first."""
    return [event[:at] for at, letter in enumerate(event) if letter == "."] + [event]


class _Misspelt:
    """The events that a machine raises and awaits, to find misspelt `raise` actions."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.waiting: dict[str, list[Transition]] = {}
        """The transitions of each event."""
        for transition in (t for state in machine.states.values() for t in state.transitions):
            self.waiting.setdefault(transition.event, []).append(transition)
        self.sent: dict[str, list[NodePath]] = {}
        """The places of the `raise` actions of each event."""
        for site in action_sites(machine):
            if isinstance(action := site.step.action, Raise):
                self.sent.setdefault(action.event, []).append(site.step.where)
        heard = {descriptor.removesuffix(".*") for descriptor in descriptors(machine) if descriptor != "*"}
        everything = "*" in descriptors(machine)
        self.lost = {name for name in self.sent if not everything and heard.isdisjoint(_prefixes(name))}
        """The raised events for which no transition waits."""


def _misnamed(event: str, misspelt: _Misspelt, report: DocumentReport) -> bool:
    """Report a `raise` that probably misspells an event for which transitions wait; return whether there is one.

    An event counts as misspelt if fewer actions raise the similar name than transitions wait for `event`.
    """
    waiting = misspelt.waiting[event]
    name = nearest(event, misspelt.lost)
    sites = misspelt.sent.get(name, [])
    if not sites or len(sites) >= len(waiting):
        return False
    path = (*sites[0], "raise")
    message = f"nothing waits for the event `{name}`, and nothing raises `{event}`"
    related = [(descriptor_path(waiting[0]), f"a transition waits for `{event}` here")]
    report(UNKNOWN_EVENT, first(report, (*path, "event"), path), message, f"did you mean `{event}`?", related=related)
    return True


def _of_the_engine(event: str) -> bool:
    """Return whether the engine could raise an event that matches this descriptor."""
    longer = tuple(family for family in BUILT_IN_FAMILIES if family.endswith("."))
    return event.startswith(longer) or any(hears(event, family.removesuffix(".")) for family in BUILT_IN_FAMILIES)


def descriptor_path(transition: Transition) -> NodePath:
    """Return the path of the key under `on`, or of the row of `hears`, even if the transition is in a list below it."""
    key = transition.hears.key if transition.hears else transition.event
    return transition.where if transition.where[-1] == key else transition.where[:-1]


def _raised(draft: ProjectDraft, name: str, report: DocumentReport) -> None:
    machine = draft.behaviors[name]
    own = set(descriptors(machine))
    for site in action_sites(machine):
        waited = own
        if isinstance(site.step.action, Send) and site.step.action.to:
            others = recipients(draft, name, site.step.action)
            waited = {"*"} if not others else {d for other in others for d in descriptors(other)}
        match site.step.action:
            case Raise(event=event) | Send(event=event) if not any(hears(d, event) for d in waited):
                verb = "raise" if isinstance(site.step.action, Raise) else "send"
                path = first(report, (*site.step.where, verb, "event"), (*site.step.where, verb))
                if nearest(event, report.missed):
                    continue  # reported there as a misspelt `raise`
                hint = did_you_mean(event, {d for d in waited if "*" not in d})
                hint = hint if "mean" in hint else "handle it under `on:`, or delete this action"
                report(UNUSED_EVENT, path, f"nothing waits for the event `{event}`", hint)
