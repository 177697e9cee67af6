"""The script of a recorded visit: the visitor's actions as those of a story, with their times."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from lumen.insight.replay.entries import JournalInput
from lumen.insight.replay.visits import RecordedVisit
from lumen.language.command_data import started
from lumen.language.controller_events import controller_events
from lumen.language.events import CLOCK_SET, Event
from lumen.language.projects import Project
from lumen.language.stories import (
    AnswerQuestion,
    Arrive,
    Happen,
    Leave,
    SendMessage,
    Speak,
    TouchSensor,
    Visitor,
    VisitorAction,
)
from lumen.language.verbs import VERBS
from lumen.run.visitor import APPROACH_DISTANCE, SPEECH_ROUTE, VISITOR_SPEED
from lumen.statechart.command_ids import result_of

FACE_ROUTE = "face"
GONE = 3.0
"""The time without a face after which the visitor has left [s]."""
COMMANDED = frozenset(("say", *(verb.name for verb in VERBS)))
"""The verbs that a story may make fail; a walk to a place consists of other commands."""
OF_ITSELF = ("arrived", "left", CLOCK_SET)
"""Events that the robot raises again by itself when it repeats its actions."""


class TimedAction(NamedTuple):
    """An action of the visitor."""

    at: float
    """The time of the action [s]."""
    action: VisitorAction
    states: tuple[str, ...] = ()
    """The states that were entered last before the action and are still active."""
    since: float = 0.0
    """When those states were entered [s]."""


def script(visit: RecordedVisit, project: Project, *, faces: bool) -> list[TimedAction]:
    """Return the visitor's actions in order.

    With `faces` the actions include each seen face that changed something, otherwise only arrivals and departures.
    """
    found = [row for entry in visit.inputs if entry.how == "heard" for row in _done(entry, project, faces=faces)]
    found += _answers(visit)
    if not faces:
        found += _walks([entry.event.at for entry in visit.inputs if _is_face(entry.event, project)], visit)
    return list(_anchored(sorted(found, key=lambda row: row.at), visit))


def broken(visit: RecordedVisit, verbs: Collection[str], *, hanging: bool, lasting: bool) -> dict[str, str | float]:
    """Return the robot's faults for `robot:` of a story: verbs that always failed.

    `verbs` are those that features and the project add. With `hanging` the result includes verbs that never ended, with
    `lasting` the shortest duration of the robot's speech [s].
    """
    begun = dict[str, tuple[str, float]]()
    kinds = dict[str, list[tuple[str, float]]]()
    for entry in visit.inputs:
        how, separator, id = entry.event.name.partition(".command.")
        if separator and id in begun:
            kind, since = begun.pop(id)
            kinds.setdefault(kind, []).append((how, entry.event.at - since))
        for command in entry.commands:
            if row := started(command):
                begun[row[0]] = _verb(row), entry.event.at
    found: dict[str, str | float] = {}
    for kind, answers in kinds.items():
        hows = {how for how, _ in answers}
        took = {round(length, 2) for how, length in answers if how == "done"}
        if hows == {"error"}:
            found[kind] = "fails"
        elif hanging and hows == {"cancelled"}:
            found[kind] = "hangs"
        elif lasting and kind == "say" and took:
            found[kind] = min(took)  # the shortest: a text that waits for another one ends later
    if hanging:
        found |= {kind: "hangs" for kind, _ in begun.values() if kind not in kinds}
    return {kind: how for kind, how in found.items() if kind in COMMANDED or kind in verbs}


def results(visit: RecordedVisit) -> dict[str, Mapping[str, Any]]:
    """Return the first result of each verb of a feature, for `robot:` of a story."""
    begun, found = dict[str, str](), dict[str, Mapping[str, Any]]()
    for entry in visit.inputs:
        how, _, id = entry.event.name.partition(".command.")
        if how == "done" and id in begun and (result := result_of(entry.event.data)) is not None:
            found.setdefault(begun[id], result)
        begun |= {row[0]: _verb(row) for command in entry.commands if (row := started(command)) and row[1] == "Do"}
    return found


def _verb(begun: tuple[str, str, Mapping[str, Any]]) -> str:
    """Return the verb of a command in the journal: an added verb, or a built-in command's class in lower case."""
    _, kind, said = begun
    return str(said.get("skill")) if kind == "Do" else kind.lower()


def _done(entry: JournalInput, project: Project, *, faces: bool) -> Iterator[TimedAction]:
    event = entry.event
    if ".command." in event.name or event.name in (*OF_ITSELF, *controller_events(project.controllers.values())):
        return
    if not _is_face(event, project):
        yield TimedAction(event.at, _action(event, project))
    elif faces and (entry.entered or entry.exited or entry.commands):
        seen = event.data if isinstance(event.data, Mapping) else {}
        yield TimedAction(event.at, Happen(event.name, {key: seen[key] for key in seen if key != "time"}))


def _action(event: Event, project: Project) -> VisitorAction:
    data = event.data
    row = next((row for row in project.routes.values() if row.event == event.name), None)
    said = data.get("result") if isinstance(data, Mapping) else None
    if row and row.name == SPEECH_ROUTE and said and isinstance(said, str) and isinstance(data, Mapping):
        heard = {key: data[key] for key in ("result", "confidence", "language") if key in data}
        return SendMessage(row.name, heard) if "confidence" in heard else Speak(said, str(data.get("language", "")))
    if event.name in ("touched", "released") and isinstance(data, Mapping):
        return TouchSensor(str(data.get("sensor")), event.name == "touched")
    if row and event.cause and event.cause.key:
        return SendMessage(row.name, data)
    return Happen(event.name, data)


def _answers(visit: RecordedVisit) -> Iterator[TimedAction]:
    """Yield the answers of the module `answers`, at their beginnings.

    Answers from passages are left out, because the story finds them again.
    """
    began = dict[str, float]()
    said = dict[str, list[str]]()
    for entry in visit.inputs:
        event = entry.event
        kind, _, id = event.name.partition(".command.")
        if kind != "answer" or not (event.cause and event.cause.key) or not isinstance(event.data, Mapping):
            continue
        match event.data:
            case {"raise": {"event": str(name), "data": dict(data)}}:
                yield TimedAction(event.at, AnswerQuestion(event=name, data=data))
            case {"text": str(text)} if text:
                began.setdefault(id, event.at)
                said.setdefault(id, []).append(text)
    for id, texts in said.items():
        yield TimedAction(began[id], AnswerQuestion(" ".join(texts)))


def _is_face(event: Event, project: Project) -> bool:
    row = project.routes.get(FACE_ROUTE)
    return row is not None and row.event == event.name


def _walks(seen: Sequence[float], visit: RecordedVisit) -> Iterator[TimedAction]:
    """Yield an arrival when a face appears, and a departure so early that the visitor is gone when the face is."""
    away = APPROACH_DISTANCE / VISITOR_SPEED
    if not seen:
        return
    yield TimedAction(seen[0], Arrive(Visitor()))
    for one, other in pairwise(seen):
        if other - one > GONE:
            yield TimedAction(one - away, Leave())
            yield TimedAction(other, Arrive(Visitor()))
    if visit.inputs[-1].event.at - seen[-1] > GONE:
        yield TimedAction(seen[-1] - away, Leave())


def _anchored(found: Sequence[TimedAction], visit: RecordedVisit) -> Iterator[TimedAction]:
    """Yield each action with the states that were entered last before it."""
    steps = iter(visit.inputs)
    entry, active, states, since = next(steps, None), set[str](), tuple[str, ...](), 0.0
    for row in found:
        while entry and entry.event.at < row.at:
            active = (active - set(entry.exited)) | set(entry.entered)
            states = tuple(state for state in states if state in active)
            if came := tuple(state for state in entry.entered if state in active):
                states, since = came, entry.event.at
            entry = next(steps, None)
        yield row._replace(states=states, since=since)
        states = ()
