"""Internals of the engine for the goldens of running exhibitions: only this module uses names that are not public.

After a rename or a move, change it here and re-record nothing: `NAMES` maps the new name of a class to the recorded
one.
"""

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from types import FunctionType, MethodType
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.language.projects import Project
from lumen.run.chosen_stories import stories_of
from lumen.run.node import Node
from lumen.run.parts.part import Part
from lumen.run.rehearsal import Rehearsal, rehearse
from lumen.run.setup import set_up

NAMES: dict[str, str] = {}
"""The recorded name of each class that has another name by now."""
PARTS = {
    "AlertPart": "alerts",
    "BrainPart": "brain",
    "BundleFollower": "bundles of the brain",
    "ConsolePart": "console",
    "FilmPart": "film",
    "FleetPart": "fleet",
    "ForgettingPart": "forgetting",
    "HostedRobotPart": "robot for other processes",
    "ModulePart": "module",
    "ModuleTroublesPart": "troubles of modules",
    "MotionPart": "motion",
    "OperatorPart": "operator",
    "RecordingPart": "recording of the bus",
    "RecordsPart": "records",
    "RefusalPart": "refused files",
    "ReloadPart": "reload",
    "RemoteBrainPart": "brain for another process's robot",
    "RemoteVisitorPart": "visitor of another process's hall",
    "RobotPart": "robot",
    "TypedVisitorPart": "typed visitor",
    "VisitorPart": "visitor",
}
OBSERVERS = {
    "ActivityTracker": "doings",
    "MeasureCounter": "measures of the fleet",
    "Narrator": "narrator",
    "RaisedEvents": "raised events",
    "RehearsalTrace": "narrator",
    "StepMemory": "memory of steps",
    "StoryPlayer": "player of the story",
    "TracePublisher": "trace",
    "Transcript": "narrator",
    "_StepHandler": "handler of the program",
    "_VisitorsTranscript": "narrator",
    "_Watcher": "coverage",
}
SERVICES = {
    "AlertDesk": "desk of alerts",
    "BehaviorLoop": "loop",
    "DeduplicationLog": "log of commands",
    "LiveBehavior": "behaviour",
    "PersonHold": "hold",
    "Presence": "presence",
    "Reloader": "reloader",
    "RobotServer": "robot server",
    "RunDirectory": "run directory",
    "RunRecords": "run records",
    "StepMemory": "memory of steps",
    "ValidatedBus": "bus",
    "Watcher": "watcher of files",
}
"""Services that several parts share."""
PROGRAMS = {
    "lumen.run.reload.validation_process": "(the process that judges files)",
    "lumen.features.console.job": "(the console's job)",
}
"""Modules that run as programs."""
DEPTH = 4
"""Depth of the search through callables and their closures."""


def project_of(root: Path, robot: str = "") -> Project:
    from lumen.project import load

    return load(root, robot=robot)


def rehearsed(project: Project, story: str) -> Rehearsal:
    """Rehearse a story as a reload and `lumen test` do."""
    return rehearse(project, next(iter(stories_of(project, story))))


def rehearsed_on(project: Project, story: str, robot: str) -> Rehearsal:
    """Rehearse a story on a robot of that name, as `lumen play` and the search for fits do."""
    found = next(iter(stories_of(project, story)))
    return rehearse(project, found, set_up(robot, project, "max", found))


def nao() -> type:
    """Return the NAO for dm_control."""
    from lumen.features.simulation.entity import Nao

    return Nao


def described(node: Node) -> dict[str, Any]:
    """Return the parts, observers and hooks of a node."""
    return {
        "claims": list(node.presence.parts) if node.presence else None,
        "parts": [_part(node, part) for part in node.parts],
        "observers": [_word(one, {**OBSERVERS, **PARTS}) for one in _observers(node)],
        "each tick before the parts": [_callable(one) for one in node._before],
        "leaps": node._time.leaps,
    }


def end(node: Node) -> None:
    """End the node as SIGTERM does."""
    node.interrupt(2, leave=True)


@contextmanager
def looked_at(ticked: Callable[[Node], None]) -> Iterator["Traces"]:
    """Call `ticked` with each node after a tick, once it has claimed its parts; yield the subscriptions and threads."""
    tick, subscribe, start = Node.tick, ValidatedBus.subscribe, threading.Thread.start
    traces = Traces()

    def ticking(node: Node) -> float:
        now = tick(node)
        if node.presence is None or node.presence.settled:
            ticked(node)
        return now

    def subscribing(bus: ValidatedBus, pattern: str, *more: Any, **named: Any) -> Any:
        traces.subscribed.append(pattern)
        return subscribe(bus, pattern, *more, **named)

    def starting(thread: threading.Thread) -> None:
        traces.threads.append(thread)
        start(thread)

    Node.tick, ValidatedBus.subscribe, threading.Thread.start = ticking, subscribing, starting  # type: ignore[method-assign]
    try:
        yield traces
    finally:
        Node.tick, ValidatedBus.subscribe, threading.Thread.start = tick, subscribe, start  # type: ignore[method-assign]


class Traces:
    """Subscriptions and started threads, in order."""

    def __init__(self) -> None:
        self.subscribed: list[str] = []
        self.threads: list[threading.Thread] = []


def _observers(node: Node) -> list[Any]:
    return next((loop.observers for loop in map(_loop, [node, *node.parts]) if loop is not None), [])


def _loop(one: Any) -> Any:
    behavior = getattr(one, "behavior", None)
    return getattr(behavior, "loop", None)


def _part(node: Node, part: Part) -> dict[str, Any]:
    name = _word(part, PARTS)
    if name == PARTS["ModulePart"]:
        name = f"module {part.name}"
    told: dict[str, Any] = {"part": name, "reaches": sorted(_reached(part))}
    if part.needs:
        told["needs"] = list(part.needs)
    if part.patient:
        told["patient"] = True
    if part not in node._begun:
        told["waits"] = True
    return told


def _word(one: object, words: dict[str, str]) -> str:
    name = type(one).__name__
    name = NAMES.get(name, name)
    return words.get(name, name)


def _callable(one: Any) -> str:
    """Return the owner and the name of a method, in the words of the tables."""
    if isinstance(one, partial):
        return _callable(one.func)
    if isinstance(one, MethodType):
        return f"{_word(one.__self__, {**PARTS, **OBSERVERS, **SERVICES})}.{one.__func__.__name__}"
    if isinstance(one, FunctionType):
        return "a function"
    return _word(one, {**PARTS, **OBSERVERS, **SERVICES})


def _reached(part: Part) -> set[str]:
    found: set[str] = set()
    for name, value in vars(part).items():
        if name != "wake":
            _reach(value, found, part, DEPTH)
    return found


def _reach(value: Any, found: set[str], of: Part, depth: int) -> None:
    """Add the words for a service, another part or an observer, and for the objects that a callable holds."""
    words = {**OBSERVERS, **SERVICES, **PARTS}
    name = NAMES.get(type(value).__name__, type(value).__name__)
    if value is of or depth == 0:
        return
    if name in words:
        found.add(words[name])
    elif isinstance(value, partial):
        for one in (value.func, *value.args, *value.keywords.values()):
            _reach(one, found, of, depth - 1)
    elif isinstance(value, MethodType):
        _reach(value.__self__, found, of, depth - 1)
    elif isinstance(value, FunctionType):
        for cell in value.__closure__ or ():
            if not _empty(cell):
                _reach(cell.cell_contents, found, of, depth - 1)


def _empty(cell: Any) -> bool:
    try:
        cell.cell_contents  # noqa: B018
    except ValueError:
        return True
    return False


def main(arguments: list[str]) -> int:
    """Run the command line in this process, and return its exit code."""
    from lumen.cli.main import main

    sys.argv = ["lumen", *arguments]
    return main(arguments)
