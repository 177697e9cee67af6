"""A recorded visit turned into a story that passes: the simplest one in which the robot repeats its actions."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import product
from math import ceil
from typing import Any, NamedTuple

from lumen.errors import LumenError, UsageError
from lumen.expressions.wall_clock import zone
from lumen.insight.replay.visits import RecordedVisit
from lumen.language.hours import WEEKDAYS, Schedule
from lumen.language.projects import Project
from lumen.language.stories import Expect, SetAutonomy, Story, StoryPause, StoryStep, VisitorAction
from lumen.project.added_verbs import usable_verbs
from lumen.run.approvals import marked_transitions
from lumen.run.loop import TICK_PERIOD
from lumen.run.storytelling.rendition import Rendition, TickNotes, played, told
from lumen.run.storytelling.visit_script import TimedAction, broken, results, script
from lumen.statechart import Snapshot, deserialize, initial

USUAL_WITHIN = 30.0
LEAD = 2.0
"""The longest time without events before a visit [s]."""
TRIES = 20
"""The number of unmet expectations that are left out before the story is given up."""

Renamed = Callable[[Any], Any]
"""A function that returns data with names replaced."""


class _Way(NamedTuple):
    """A way to write the story."""

    lasting: bool
    """Whether to set the time that the robot speaks."""
    hanging: bool
    """Whether to set the verbs that never ended."""
    faces: bool
    """Whether to repeat each face that was seen."""
    clocked: bool
    """Whether actions follow each other by time alone, without expected states."""


WAYS = [_Way(*way) for way in product((False, True), repeat=4)]
"""All ways, from the one that a person would write to the most exact."""


@dataclass(frozen=True)
class VisitStory:
    """A story of a visit."""

    story: Story
    same: bool
    """Whether the robot's observable actions in the story are those of the visit."""
    was: str = ""
    """The first action of the robot that differs, as recorded."""
    now: str = ""
    """The robot's action in the story at that point."""


def visit_story(
    project: Project, old: Project, visit: RecordedVisit, *, name: str, title: str, renamed: Renamed = lambda data: data
) -> VisitStory:
    """Return the story of a visit that was recorded with the files of `old`, as it runs with those of `project`.

    `renamed` replaces names in the recorded words. Raises UsageError if no story can be made.
    """
    home = visit.home
    if home is None or home.snapshot is None or not visit.inputs:
        raise UsageError("the beginning of that visit is not in the journal: no story can be made of it")
    if home.behavior not in project.behaviors:
        raise UsageError(f"the behaviour `{home.behavior}` no longer exists: no story can be made of that visit")
    stands = deserialize(old.machine, home.snapshot)
    blank = _blank(project, stands, visit, name, title, renamed)
    was = told([(entry.event.at, renamed(command)) for entry in visit.inputs for command in entry.commands])
    approved = _approved(project, visit)
    best: tuple[int, Rendition, Sequence[TimedAction], Story] | None = None
    tried: list[Story] = []
    for way in WAYS:
        acts: Sequence[TimedAction] = [
            row._replace(action=_without(row.action, renamed)) for row in script(visit, project, faces=way.faces)
        ]
        robot = broken(visit, {*usable_verbs(), *project.verbs}, hanging=way.hanging, lasting=way.lasting)
        steps = (*approved, *_draft(acts, visit, clocked=way.clocked))
        draft = replace(blank, robot=robot, results=results(visit), steps=steps)
        if not draft.steps or draft in tried:
            continue
        tried.append(draft)
        rendition = played(project, draft)
        alike = _alike(was, rendition.told)
        if rendition.rehearsal.failed is None and (best is None or alike > best[0]):
            best = alike, rendition, acts, draft
            if alike == len(was):
                break
    if best is None:
        raise UsageError("that visit can't be played as a story on the recording robot")
    alike, rendition, acts, draft = best
    story = _checked(project, draft, rendition, [row.action for row in acts])
    if alike == len(was):
        return VisitStory(story, same=True)
    now = rendition.told[alike] if alike < len(rendition.told) else "nothing"
    return VisitStory(story, same=False, was=was[alike], now=now)


def _blank(project: Project, stands: Snapshot, visit: RecordedVisit, name: str, title: str, renamed: Renamed) -> Story:
    """Return a story without steps that begins with the state of the world before the visit."""
    assert visit.home is not None
    machine = project.behaviors[visit.home.behavior]
    first = initial(machine, language=stands.language).snapshot.context
    context = {key: value for key, value in stands.context.items() if key in first and first[key] != value}
    return Story(
        name=name,
        title=title,
        steps=(),
        behavior="" if visit.home.behavior == project.behavior else visit.home.behavior,
        language="" if stands.language == project.languages[0] else stands.language,
        clock=_clock(stands, visit),
        context=renamed(context),
    )


def _clock(stands: Snapshot, visit: RecordedVisit) -> Schedule:
    moment = datetime.fromtimestamp(visit.began, zone(stands.timezone))
    text = f"{WEEKDAYS[moment.weekday()]} {moment:%H:%M}"
    return Schedule((moment.hour * 60 + moment.minute,), weekdays=(moment.weekday(),), text=text)


def _draft(acts: Sequence[TimedAction], visit: RecordedVisit, *, clocked: bool) -> Iterator[StoryStep]:
    """Yield the actions, each at the recorded delay after the robot's last one.

    With `clocked` the delay counts from the previous action.
    """
    assert visit.home is not None
    last = max(visit.home.at, visit.inputs[0].event.at - LEAD)
    for row in acts:
        if row.states and not clocked and row.since >= last:
            yield StoryStep(Expect(states=row.states, within=max(USUAL_WITHIN, 2 * (row.since - last) + 10)))
            last = row.since
        if row.at - last > TICK_PERIOD:
            yield StoryStep(StoryPause(round(row.at - last, 2)))
        yield StoryStep(row.action)
        last = row.at
    yield StoryStep(StoryPause(round(max(0.0, visit.inputs[-1].event.at - last) + 2 * TICK_PERIOD, 2)))


def _approved(project: Project, visit: RecordedVisit) -> tuple[StoryStep, ...]:
    """Return a step that turns approval off: recorded events had GO already; empty without marked transitions."""
    assert visit.home is not None
    marked = marked_transitions(project.behaviors[visit.home.behavior])
    return (StoryStep(SetAutonomy("alone")),) if marked else ()


def _alike(was: Sequence[str], now: Sequence[str]) -> int:
    """Return how many of the recorded actions `was` are repeated by `now` before the first difference."""
    return next((i for i, row in enumerate(was) if i >= len(now) or now[i] != row), len(was))


def _checked(project: Project, draft: Story, rendition: Rendition, acts: Sequence[VisitorAction]) -> Story:
    """Return the story with the observations as expectations, without expectations that are not met in time.

    Raises UsageError if the events of the story do not repeat.
    """
    approved = [step for step in draft.steps if isinstance(step.action, SetAutonomy)]
    left_out = set[int]()
    for digits in (1, 2):
        for _ in range(TRIES):
            rows = list(_steps(rendition, acts, left_out, digits))
            story = replace(draft, steps=(*approved, *(StoryStep(action) for _, action in rows)))
            again = played(project, story)
            failed = again.rehearsal.failed
            if failed is None:
                if _alike(rendition.told, again.told) == len(rendition.told) or digits == 2:
                    return story
                break
            number = rows[max(failed.step - 1 - len(approved), 0)][0]
            if number is None:
                break
            left_out.add(number)
        left_out = set()
    raise UsageError("that visit can't be played as a story: its events do not repeat in the same way")


def _steps(
    rendition: Rendition, acts: Sequence[VisitorAction], left_out: set[int], digits: int
) -> Iterator[tuple[int | None, VisitorAction]]:
    """Yield the steps in order; an expectation comes with the index of its tick's notes, an action with None."""
    rows: list[tuple[float, int, int]] = [(at, 0, i) for i, at in enumerate(rendition.acted)]
    rows += [(notes.at, 1, i) for i, notes in enumerate(rendition.ticks)]
    last, before = 0.0, frozenset[str]()
    for at, kind, i in sorted(rows):
        if kind == 0:
            if at - last > TICK_PERIOD:
                yield None, StoryPause(round(at - last, digits) or TICK_PERIOD)
            yield None, acts[i]
            last = at
            continue
        notes = rendition.ticks[i]
        expected = _expected(notes, before, at - last)
        before = notes.active or before
        if expected and i not in left_out and not (i == 0 and at <= TICK_PERIOD):
            yield i, expected
            last = at + TICK_PERIOD


def _expected(notes: TickNotes, before: frozenset[str], gap: float) -> Expect | None:
    fresh = [state for state in dict.fromkeys(notes.entered) if state in notes.active and state not in before]
    states = tuple(fresh[-1:])
    said, exactly = [*notes.said, None, None][:2]
    if not (states or said or notes.played or notes.published):
        return None
    within = USUAL_WITHIN if gap < USUAL_WITHIN - 5 else float(ceil(1.2 * gap + 10))
    motion, route = (row[-1] if row else None for row in (notes.played, notes.published))
    return Expect(states=states, said=said, said_exactly=exactly, played=motion, published=route, within=within)


def renaming(names: Mapping[str, str]) -> Renamed:
    """Return a function that replaces names in texts, anywhere in data."""

    patterns = [(re.compile(rf"(?<!\w){re.escape(old)}(?!\w)", re.IGNORECASE), new) for old, new in names.items()]

    def renamed(data: Any) -> Any:
        match data:
            case str():
                for pattern, new in patterns:
                    data = new.join(pattern.split(data))
                return data
            case Mapping():
                return {key: renamed(value) for key, value in data.items()}
            case list() | tuple():
                return [renamed(value) for value in data]
        return data

    return renamed


def _without(action: VisitorAction, renamed: Renamed) -> VisitorAction:
    """Return an action with replaced names."""
    found = {name: renamed(value) for name in ("text", "data", "body") if (value := getattr(action, name, None))}
    try:
        return replace(action, **found) if found else action
    except (TypeError, LumenError):
        return action
