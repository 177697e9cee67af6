"""The present state of a running exhibition in one JSON object, for consoles."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from lumen.insight.explaining.foresight import foreseen
from lumen.insight.explaining.names import machines_in
from lumen.insight.explaining.outlook import GuardTruth, Running, WayOut, running, ways_out
from lumen.insight.explaining.pressing import ShownButton, shown_buttons
from lumen.language.approvals import Autonomy
from lumen.language.diagnostics import NodePath
from lumen.language.events import robot_events
from lumen.language.iso_time import iso_time
from lumen.language.machines import MachineDefinition, Transition
from lumen.language.projects import Project
from lumen.run.activity_tracker import ActivityTracker, Spoken, UnderWay
from lumen.run.approvals import Approvals, HeldEvent
from lumen.statechart import Snapshot

Status = dict[str, Any]


class PresentMoment(NamedTuple):
    """The state of an exhibition between two ticks; `status` returns the rest of the data, on any thread."""

    project: Project
    snapshot: Snapshot
    """The behaviour's snapshot."""
    at: float
    """The exhibition's time [s]."""
    position: int
    """The position of the last entry of the journal."""
    since: dict[str, float]
    """When each active state became active [s], by name."""
    saying: UnderWay | None
    """The text that is being said; None if there is none."""
    motion: UnderWay | None
    """The motion under way; None if there is none."""
    heard: Spoken | None
    """The visitor's last words; None until a visitor has spoken."""
    waiting: tuple[HeldEvent, ...]
    """The events that wait for GO."""
    autonomy: Autonomy
    """`ask` or `alone`."""
    model: str | None
    """Whether the language model is `on` or `off`; None if there is no model."""
    events: int
    """The number of events that wait for the next tick."""
    commands: int
    """The number of unfinished commands."""
    status: Callable[[], Status]
    """Returns the data of `lumen status`."""


def moment(
    project: Project,
    snapshot: Snapshot,
    at: float,
    activity: ActivityTracker,
    *,
    position: int,
    approvals: Approvals,
    model: str | None,
    events: int,
    status: Callable[[], Status],
) -> PresentMoment:
    """Return the present state without converting it yet; `NowView` does that on another thread."""
    said, moved = activity.saying, activity.motion
    return PresentMoment(
        project,
        snapshot,
        at,
        position,
        activity.since,
        said,
        moved,
        activity.heard,
        approvals.waiting,
        approvals.autonomy,
        model,
        events,
        activity.commands,
        status,
    )


class NowView:
    """A converter of moments to JSON data, which caches what depends only on the bundle."""

    def __init__(self) -> None:
        self._bundle: _Bundle | None = None

    def tell(self, now: PresentMoment) -> dict[str, Any]:
        """Return a moment as JSON data, including all keys of the status."""
        bundle = self._bundle
        if bundle is None or bundle.project is not now.project:
            bundle = self._bundle = _Bundle(now.project)

        def time(at: float) -> str:
            return iso_time(now.snapshot.epoch + at)

        return {
            **now.status(),
            "time": time(now.at),
            "position": now.position,
            "states": _tree(now, bundle, time),
            "saying": _saying(now.saying, time),
            "motion": _motion(now.motion, now.at, time),
            "visitor_said": {"text": now.heard.text, "at": time(now.heard.at)} if now.heard else None,
            "ways": [_way(way, bundle, time) for way in ways_out(now.project.machine, now.snapshot, now.at)],
            "buttons": [_button(one, now.project) for one in shown_buttons(now.project.machine, now.snapshot, now.at)],
            "waiting": [_held(held, now, bundle, time) for held in now.waiting],
            "autonomy": now.autonomy,
            "model": now.model,
            "queues": {"events": now.events, "commands": now.commands},
            **bundle.constant,
        }


class _Bundle:
    """The data that depends only on a project: the places of its states, and the names that a console offers."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._files = {id(machine): f"behaviors/{name}.yaml" for name, machine in project.behaviors.items()}
        self._by_id = {machine.id: f"behaviors/{name}.yaml" for name, machine in project.behaviors.items()}
        self._places: dict[tuple[int, NodePath], tuple[str | None, int | None]] = {}
        self.constant: dict[str, Any] = {
            "languages": list(project.languages),
            "motions": sorted(project.motions),
            "postures": sorted(project.body.postures),
            "events": sorted(handled_events(project.machine)),
        }

    def place(self, machine: MachineDefinition, where: NodePath) -> dict[str, Any]:
        """Return the file and line of a node in a machine's document; None for both if they are unknown."""
        found = self._places.get((id(machine), where))
        if found is None:
            file = self._files.get(id(machine)) or self._by_id.get(machine.id)
            place = self.project.place(file, where) if file else None
            found = (place.file, place.line) if place else (None, None)
            self._places[id(machine), where] = found
        return {"file": found[0], "line": found[1]}


def handled_events(machine: MachineDefinition) -> set[str]:
    """Return the names of external events for which a behaviour, or one that it invokes, has a transition."""
    found = set[str]()
    for _, inner in machines_in(machine):
        declared = set(inner.events)
        for state in inner.states.values():
            for transition in state.transitions:
                found.update(_names(transition, declared))
    return found


def _names(transition: Transition, declared: set[str]) -> Iterator[str]:
    event = transition.event
    if transition.timed or transition.exact or not event or event.startswith(("done.", "error.")):
        return
    if event == "*":
        yield from declared
        return
    prefix = event.removesuffix(".*")
    below = [name for name in (*declared, *robot_events()) if name.startswith(f"{prefix}.")]
    yield from below
    if prefix == event or not below:
        yield prefix


def _tree(now: PresentMoment, bundle: _Bundle, time: Callable[[float], str]) -> list[dict[str, Any]]:
    """Return the active states as a tree; the states of an invoked behaviour are below the state that invokes it."""
    found: dict[str, dict[str, Any]] = {}
    outermost: list[dict[str, Any]] = []
    for one in running(now.project.machine, now.snapshot):
        for state in _active(one):
            path, name = one.prefix + state.path, one.prefix + state.name
            since = time(now.since.get(name, now.snapshot.at))
            node = {
                "path": path,
                "name": name,
                "since": since,
                **bundle.place(one.machine, state.where),
                "children": [],
            }
            found[path] = node
            around = found.get(one.prefix + state.parent if state.parent else one.host)
            (around["children"] if around else outermost).append(node)
    return outermost


def _active(one: Running) -> Iterator[Any]:
    names = one.snapshot.configuration
    left = [one.machine.states[path] for path in reversed(one.machine.root.children)]
    while left:
        state = left.pop()
        if state.name in names:
            yield state
            left += [one.machine.states[path] for path in reversed(state.children)]


def _saying(said: UnderWay | None, time: Callable[[float], str]) -> dict[str, Any] | None:
    return {"text": said.name, "language": said.language, "since": time(said.since)} if said else None


def _motion(moved: UnderWay | None, at: float, time: Callable[[float], str]) -> dict[str, Any] | None:
    if moved is None:
        return None
    progress = min(1.0, max(0.0, (at - moved.since) / moved.seconds)) if moved.seconds else None
    return {"verb": moved.what, "name": moved.name, "since": time(moved.since), "progress": progress}


def _way(way: WayOut, bundle: _Bundle, time: Callable[[float], str]) -> dict[str, Any]:
    states, wanted = way.machine.states, way.transition
    prefix = "".join(f"{id}/" for id in reversed(way.owner.split("@"))) if way.owner else ""
    return {
        "source": prefix + (states[wanted.source].name or way.machine.id),
        "event": wanted.hears.title if wanted.hears else wanted.awaited_time or wanted.event,
        "targets": [prefix + (states[path].name or way.machine.id) for path in wanted.targets],
        **bundle.place(way.machine, wanted.where),
        "due": None if way.due is None else time(way.due),
        "open": way.open,
        "guard": _guard(way.guard) if way.guard else None,
        "why": way.why,
    }


def _button(shown: ShownButton, project: Project) -> dict[str, Any]:
    button = shown.button
    labels = dict.fromkeys(project.languages, button.label[""]) if "" in button.label else dict(button.label)
    return {
        "label": labels,
        "event": button.event,
        "data": button.data,
        "confirm": button.confirm or None,
        "key": shown.key or None,
        "state": shown.state,
        "enabled": shown.enabled,
        "reason": shown.reason,
    }


def _held(held: HeldEvent, now: PresentMoment, bundle: _Bundle, time: Callable[[float], str]) -> dict[str, Any]:
    machine, wanted, approval = held.marked
    event = held.event._replace(at=now.at)
    return {
        "id": held.id,
        "event": held.event.name,
        "data": held.event.data,
        "source": machine.states[wanted.source].name or machine.id,
        "targets": [machine.states[path].name or machine.id for path in wanted.targets],
        **bundle.place(machine, wanted.where),
        "since": time(held.since),
        "until": None if approval.within is None else time(held.until),
        "else": approval.otherwise,
        "would": foreseen(now.project.machine, now.snapshot, event),
    }


def _guard(guard: GuardTruth) -> dict[str, Any]:
    return {"text": guard.text, "true": guard.holds, "values": dict(guard.values)}
