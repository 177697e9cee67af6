"""Build a `Story` or a `SayingSet` from the plain data of a file in `behaviors/stories/` or `behaviors/sayings/`."""

from collections.abc import Iterator, Mapping
from math import isfinite
from types import MappingProxyType
from typing import Any

from lumen.expressions.own_functions import KnownFunctions
from lumen.language.added_verbs import given_arguments
from lumen.language.diagnostics import NodePath
from lumen.language.hours import Schedule
from lumen.language.sayings import Saying, SayingSet
from lumen.language.stories import (
    AnswerQuestion,
    Approve,
    Arrive,
    AwaitTime,
    Expect,
    Happen,
    Leave,
    Press,
    SendMessage,
    SetAutonomy,
    SetSkills,
    Speak,
    Story,
    StoryPause,
    StoryStep,
    TouchSensor,
    Visitor,
    VisitorAction,
)
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import NOT_A_NUMBER
from lumen.project.routes import duration
from lumen.project.schedules import BAD_TIME, schedule
from lumen.project.state_parts import build_properties, unbound_conditions
from lumen.project.units import BAD_DURATION, seconds

DEFAULT_WITHIN = 30.0
"""The default of `within`: how long an expectation waits [s]."""


def build_story(
    data: Any,
    report: DocumentReport,
    *,
    name: str,
    verbs: OwnVerbs = NO_VERBS,
    functions: KnownFunctions = MappingProxyType({}),
) -> Story | None:
    """Return the story in the data of `behaviors/stories/NAME.yaml`, or None if it has no steps.

    Steps that can't be read are reported and left out. `verbs` are those that the project declares; `functions` are its
    functions, which the story's properties may call.
    """
    if not isinstance(data, Mapping) or not data.get("steps"):
        return None
    rows = ((("steps", i), row) for i, row in enumerate(data["steps"]))
    return Story(
        name=name,
        title=data.get("title", name),
        steps=tuple(StoryStep(action, where) for where, row in rows if (action := _action(row, report, where, verbs))),
        behavior=data.get("behavior", ""),
        language=data.get("language", ""),
        clock=_moment(data["at"], report, ("at",)) if "at" in data else None,
        context=data.get("context", {}),
        robot=_performances(data.get("robot", {}), report),
        results={
            verb: how["result"]
            for verb, how in data.get("robot", {}).items()
            if isinstance(how, Mapping) and "result" in how
        },
        never=tuple(data.get("never", ())),
        properties=build_properties(data, report, unbound_conditions(report, functions)),
    )


def _performances(data: Mapping[str, Any], report: DocumentReport) -> dict[str, str | float]:
    """Return `fails`, `hangs` or a duration [s] by verb; in a map, the duration is under `takes`."""
    found = {}
    for verb, how in data.items():
        if not isinstance(how, Mapping):
            found[verb] = _performance(how, report, ("robot", verb))
        elif "takes" in how:
            found[verb] = _performance(how["takes"], report, ("robot", verb, "takes"))
    return found


def _performance(how: str, report: DocumentReport, where: NodePath) -> str | float:
    """Return `fails`, `hangs`, or a duration [s]; a duration that can't be read is reported and counts as `fails`."""
    if how in ("fails", "hangs"):
        return how
    length = seconds(how)
    if length is None:
        report(
            BAD_DURATION, where, f"`{how}` is not a duration", hint="write `fails`, `hangs` or a duration such as `2s`"
        )
        return "fails"
    return length


def _action(row: Mapping[str, Any], report: DocumentReport, where: NodePath, verbs: OwnVerbs) -> VisitorAction | None:
    [(verb, body)] = row.items()
    match verb:
        case "visitor":
            return _visitor(body, report, (*where, verb))
        case "says":
            return Speak(body) if isinstance(body, str) else Speak(body["text"], body.get("language", ""))
        case "touch" | "release":
            return TouchSensor(body, verb == "touch")
        case "event":
            return Happen(body) if isinstance(body, str) else Happen(body["name"], body.get("data"))
        case "message":
            return SendMessage(body["route"], body.get("body"))
        case "answers":
            said = isinstance(body, str)
            return AnswerQuestion(body) if said else AnswerQuestion(event=body["raise"], data=body.get("data", {}))
        case "skills":
            return SetSkills(body)
        case "operator":
            return _operator(body)
        case "wait":
            length = duration(row, "wait", report, where)
            return None if length is None else StoryPause(length)
        case "at":
            time = _moment(body, report, (*where, verb))
            return None if time is None else AwaitTime(time)
        case "expect":
            return _expect(body, report, (*where, verb), verbs)
    return None


def _operator(body: Mapping[str, Any]) -> VisitorAction:
    match body:
        case {"approve": str(word)}:
            return Approve(word == "go")
        case {"autonomy": str(level)}:
            return SetAutonomy("alone" if level == "alone" else "ask")
    return Press(body["press"])


def _moment(text: str, report: DocumentReport, where: NodePath) -> Schedule | None:
    """Return a moment, which may include the day; None for a faulty text or several times, which are reported."""
    found = schedule(text, report, where)
    if found and len(found.times) > 1:
        hint = "write one of them here, and a separate story for each of the others"
        report(
            BAD_TIME, where, f"`{text}` contains {len(found.times)} times of day, but a story begins once", hint=hint
        )
        return None
    return found


def _visitor(body: Any, report: DocumentReport, where: NodePath) -> VisitorAction | None:
    if isinstance(body, str):
        return Arrive(Visitor()) if body == "arrives" else Leave()
    for key, value in body.items():
        if not isfinite(value):
            report(NOT_A_NUMBER, (*where, key), f"`{value}` can't be used here", hint="write a finite number")
            return None
    return Arrive(Visitor(**{key: float(value) for key, value in body.items()}))


def _did(data: Any, verbs: OwnVerbs) -> dict[str, Mapping[str, Any]]:
    """Return the arguments in `did: blink`, `did: {blink: 3}` or `did: {blink: {times: 3}}`, by the added verb."""
    if isinstance(data, str):
        return {data: {}}
    return {verb: given_arguments(verbs.all[verb], given) for verb, given in data.items()}


def _expect(body: Mapping[str, Any], report: DocumentReport, where: NodePath, verbs: OwnVerbs) -> Expect:
    states, published = body.get("state", ()), body.get("published")
    message = published if isinstance(published, Mapping) else {"route": published}
    did = _did(body.get("did", {}), verbs)
    within = duration(body, "within", report, where)
    return Expect(
        states=(states,) if isinstance(states, str) else tuple(states),
        said=body.get("said"),
        said_exactly=body.get("said_exactly"),
        played=body.get("played"),
        did=next(iter(did), None),
        arguments=next(iter(did.values()), {}),
        published=message["route"],
        body=message.get("body"),
        context=body.get("context", {}),
        place=body.get("place"),
        within=DEFAULT_WITHIN if within is None else within,
    )


SAY = "say"


def build_sayings(data: Any, report: DocumentReport, *, name: str) -> SayingSet | None:
    """Return the sayings in the data; None if the data is not a map."""
    return SayingSet(name, tuple(_sayings(data))) if isinstance(data, Mapping) else None


def _sayings(data: Mapping[str, Any]) -> Iterator[Saying]:
    for behavior, states in data.items():
        for state, rows in states.items():
            for row, languages in rows.items():
                for language, said in languages.items():
                    for i, one in enumerate(said):
                        body = {SAY: one} if isinstance(one, str) else one
                        slots = {slot: value for slot, value in body.items() if slot != SAY}
                        where = (behavior, state, row, language, i)
                        yield Saying(behavior, state, row, language, body[SAY], slots, where)
