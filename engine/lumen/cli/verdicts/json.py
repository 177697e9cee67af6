"""A verdict as one JSON object, for other programs."""

import json
from typing import Any

from lumen.language.diagnostics import Place
from lumen.retrieval.ranking import QuestionTrial
from lumen.run.coverage import Coverage
from lumen.run.exploring import Explored
from lumen.run.rehearsal import Rehearsal
from lumen.run.verdict import JudgedExample, JudgedSaying, Verdict


def render(verdict: Verdict) -> str:
    """Return `{"stories": […], "failed": N, "took": s}`, and `sayings`, `examples`, `questions`, … if there are any.

    `failed` is the number of failed stories, and `took` is in [s].
    """
    found: dict[str, Any] = {
        "stories": [_story(rehearsal) for rehearsal in verdict.rehearsals],
        "failed": verdict.failed,
        "took": round(verdict.took, 3),
    }
    if verdict.sayings:
        found["sayings"] = [_saying(one) for one in verdict.sayings]
    if verdict.examples:
        found["examples"] = [_example(one) for one in verdict.examples]
    if verdict.trials:
        found["questions"] = [_tried(trial) for trial in verdict.trials]
    if verdict.coverage:
        found["coverage"] = _coverage(verdict.coverage)
    if verdict.explored:
        found["explore"] = _explored(verdict.explored)
    return json.dumps(found, indent=2, ensure_ascii=False)


def _story(rehearsal: Rehearsal) -> dict[str, Any]:
    story, failed = rehearsal.story, rehearsal.failed
    found: dict[str, Any] = {
        "name": story.name,
        "title": story.title,
        "passed": failed is None,
        "time": round(rehearsal.time, 3),
        "took": round(rehearsal.took, 3),
    }
    if failed is not None:
        found["failure"] = {
            **_place(rehearsal.place),
            "step": failed.step,
            "expected": failed.expected,
            "was": failed.was,
            "trace": [{"time": round(time, 3), "who": who, "what": what} for time, who, what in rehearsal.trace],
        }
    return found


def _saying(one: JudgedSaying) -> dict[str, Any]:
    said, wrong = one.tried.saying, one.tried.wrong
    return {
        **_place(one.place),
        "said": said.text,
        "behavior": said.behavior,
        "state": said.state,
        "language": said.language,
        "row": said.row,
        "took": one.tried.took or None,
        "passed": not wrong,
        **({"wrong": wrong} if wrong else {}),
    }


def _example(one: JudgedExample) -> dict[str, Any]:
    wrong = one.tried.wrong
    return {**_place(one.place), "call": one.tried.call, "passed": not wrong, **({"wrong": wrong} if wrong else {})}


def _tried(trial: QuestionTrial) -> dict[str, Any]:
    return {
        "language": trial.language,
        "asked": trial.asked,
        "least": trial.least,
        "rates": trial.rates._asdict(),
        "others": trial.others._asdict(),
        "wrong": [each._asdict() for each in trial.wrong],
        "unfound": [each._asdict() for each in trial.unfound],
    }


def _coverage(coverage: Coverage) -> dict[str, Any]:
    return {
        "percent": round(coverage.percent, 1),
        **{what: {"covered": some, "of": every} for what, (some, every) in coverage.counts.items()},
        "gaps": [{**_place(gap.place), "message": gap.what} for gap in coverage.gaps()],
    }


def _explored(explored: Explored) -> dict[str, Any]:
    return {
        "behavior": explored.behavior,
        "configurations": explored.configurations,
        "steps": explored.steps,
        "complete": explored.complete,
        "took": round(explored.took, 3),
        "known": explored.known,
        "kept": list(explored.kept),
        "findings": [
            {**_place(f.place), "kind": f.kind, "message": f.message, "story": f.story} for f in explored.findings
        ],
        "unseen": [{**_place(gap.place), "message": gap.what} for gap in explored.unseen],
    }


def _place(place: Place | None) -> dict[str, Any]:
    return {"file": place.file, "line": place.line, "column": place.column} if place else {}
