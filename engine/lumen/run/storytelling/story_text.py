"""A story as the text of its file."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any, assert_never

import yaml

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
    TouchSensor,
    Visitor,
    VisitorAction,
)

HEAD = "# yaml-language-server: $schema=../../schemas/story.schema.json"
USUAL_WITHIN = 30.0
"""The default of `within` [s]; a story's text leaves it out."""


def story_text(story: Story, remarks: list[str]) -> str:
    """Return a story as YAML, with `remarks` as comments at the top."""
    lines = [HEAD, *(f"# {remark}" for remark in remarks), f"title: {flow(story.title)}"]
    robot: dict[str, Any] = {verb: how if isinstance(how, str) else f"{how:g}s" for verb, how in story.robot.items()}
    for verb, result in story.results.items():
        robot[verb] = {**({"takes": robot[verb]} if verb in robot else {}), "result": dict(result)}
    top: Mapping[str, Any] = {
        "behavior": story.behavior,
        "language": story.language,
        "at": story.clock.text if story.clock else "",
        "context": dict(story.context),
        "robot": robot,
    }
    lines += [f"{key}: {flow(value)}" for key, value in top.items() if value]
    return "\n".join([*lines, "steps:", *(f"  - {line}" for line in _steps(story))]) + "\n"


def flow(value: Any) -> str:
    """Return a value as YAML on one line."""
    text: str = yaml.safe_dump([value], default_flow_style=True, allow_unicode=True, sort_keys=False, width=10**6)
    return text.strip()[1:-1]


def _steps(story: Story) -> Iterator[str]:
    return (f"{verb}: {flow(body)}" for verb, body in map(_step, (step.action for step in story.steps)))


def _step(action: VisitorAction) -> tuple[str, Any]:
    match action:
        case Arrive(visitor):
            return "visitor", "arrives" if visitor == Visitor() else asdict(visitor)
        case Leave():
            return "visitor", "leaves"
        case Speak(text, language):
            return "says", {"text": text, "language": language} if language else text
        case TouchSensor(sensor, pressed):
            return "touch" if pressed else "release", sensor
        case Happen(name, data):
            return "event", name if data is None else {"name": name, "data": data}
        case Press(label):
            return "operator", {"press": label}
        case Approve(go):
            return "operator", {"approve": "go" if go else "stay"}
        case SetAutonomy(level):
            return "operator", {"autonomy": level}
        case SendMessage(route, body):
            return "message", {"route": route, "body": body}
        case AnswerQuestion(text, event, data):
            return "answers", text or {"raise": event, **({"data": dict(data)} if data else {})}
        case SetSkills(ends):
            return "skills", {name: end if isinstance(end, str) else dict(end) for name, end in ends.items()}
        case StoryPause(seconds):
            return "wait", f"{seconds:g}s"
        case AwaitTime(schedule):
            return "at", schedule.text
        case Expect():
            return "expect", _expected(action)
    assert_never(action)


def _expected(wanted: Expect) -> dict[str, Any]:
    states = wanted.states[0] if len(wanted.states) == 1 else list(wanted.states)
    published = {"route": wanted.published, "body": wanted.body} if wanted.body is not None else wanted.published
    found = {
        "state": states,
        "said": wanted.said,
        "said_exactly": wanted.said_exactly,
        "played": wanted.played,
        "did": {wanted.did: dict(wanted.arguments)} if wanted.did and wanted.arguments else wanted.did,
        "published": published,
        "within": None if wanted.within == USUAL_WITHIN else f"{wanted.within:g}s",
    }
    return {key: value for key, value in found.items() if value}
