"""The places in lumen.yaml: whether they exist, are on the stage, far enough apart, and used."""

import re
from collections.abc import Iterable, Iterator
from itertools import combinations
from math import hypot, pi

from lumen.expressions import split_template
from lumen.language.commands import GoTo
from lumen.language.diagnostics import ERROR, INFO, WARNING, Code, NodePath, did_you_mean, has_errors
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.language.hall_places import HallPlace, HallPlaces
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Stage
from lumen.language.stories import Expect
from lumen.lint.units import HALF_TURN_PARTS, WRONG_UNIT
from lumen.lint.walk import action_sites
from lumen.lint.word_tables import word_tables
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

PLACE_OFF_STAGE = Code("place-off-stage", "robot", ERROR, "a place is outside the area that the robot's feet may enter")
PLACES_TOO_CLOSE = Code("places-too-close", "robot", WARNING, "two places are too close for the robot to tell apart")
UNKNOWN_PLACE = Code("unknown-place", "references", ERROR, "a name refers to a place that is not in lumen.yaml")
UNUSED_PLACE = Code("unused-place", "references", INFO, "no walk leads to a place")

_ENTRY = re.compile(r"\{\{\s*(?:in_language\()?context\.(?P<key>\w+)\.entry\.(?P<field>\w+)\)?\s*\}\}")
_LIST = re.compile(r"lists\.(\w+)")

SOLE_REACH = 0.1
"""The distance from the point between the feet to the edge of a sole [m]."""


def check(draft: ProjectDraft) -> None:
    """Report places that are unknown, out of reach, too close or unused, and headings in the wrong unit."""
    if draft.settings is None or draft.main is None:
        return
    walked, places = set(), draft.settings.section(HallPlaces).by_name
    for report, path, name in _named(draft):
        walked.add(name)
        known_place(draft, report, path, name)
    for name, place in places.items():
        _heading(draft.main, name)
        if draft.settings.stage:
            _on_stage(draft.main, name, place, draft.settings.stage)
    _apart(draft.main, places.items())
    if not has_errors(draft.diagnostics):
        _used(draft, draft.main, walked)


def known_place(draft: ProjectDraft, report: DocumentReport, path: NodePath, name: str) -> bool:
    """Return whether lumen.yaml has that place; if not, report the name, unless an unreadable part could have it."""
    assert draft.settings
    assert draft.main
    places = draft.settings.section(HallPlaces).by_name
    if name in places:
        return True
    if name not in draft.main.lost:
        hint, cause = did_you_mean(name, places, "lumen.yaml has"), f"name {name}"
        if not places:
            hint, cause = f"write `places: {{{name}: {{x: 1, y: 0}}}}` in lumen.yaml, which has no places", "no places"
        report(UNKNOWN_PLACE, path, f"there is no place `{name}`", hint, cause=cause)
    return False


def _named(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath, str]]:
    """Yield each place that a walk, a story's expectation or a passage names, with the report and path of the name.

    Computed names are left out, except those from list entries (`_listed`).
    """
    for behavior, machine in draft.behaviors.items():
        for site in action_sites(machine):
            if isinstance(site.step.action, GoTo) and "{{" not in site.step.action.to:
                yield draft.report("behaviors", behavior), (*site.step.where, "walk", "to"), site.step.action.to
        yield from _listed(draft, machine)
    for name, story in draft.stories.items():
        for step in story.steps:
            if isinstance(step.action, Expect) and step.action.place:
                yield draft.report("behaviors/stories", name), (*step.where, "expect", "place"), step.action.place
    for name, passage in draft.knowledge.items():
        if passage.place:
            yield draft.report(KNOWLEDGE_FOLDER, name), ("place",), passage.place


def _listed(draft: ProjectDraft, machine: MachineDefinition) -> Iterator[tuple[DocumentReport, NodePath, str]]:
    """Yield the places that walks of a behaviour read from list entries, each with the report and path of its value.

    Such a walk leads to a field of the entry that a `for` over a list has reached: `{{ context.KEY.entry.FIELD }}`.
    Fields that are missing or not texts are left out.
    """
    loops = {state.for_each.key: state.for_each for state in machine.states.values() if state.for_each}
    walks = {step.to for site in action_sites(machine) if isinstance(step := site.step.action, GoTo)}
    for found in filter(None, map(_ENTRY.fullmatch, sorted(walks))):
        if found["key"] not in loops or not (listed := _LIST.fullmatch(loops[found["key"]].each.source)):
            continue
        table, field = listed[1], found["field"]
        for tables in word_tables(draft):
            if table in tables.lists and machine.lists.get(table) is tables.lists[table]:
                for i, entry in enumerate(tables.lists[table]):
                    if isinstance(place := entry.get(field), str):
                        yield tables.report, ("lists", table, i, field), place


def _computed(draft: ProjectDraft) -> bool:
    """Return whether the place of some walk is known only at run time."""
    actions = [site.step.action for machine in draft.behaviors.values() for site in action_sites(machine)]
    texts = [action.to for action in actions if isinstance(action, GoTo)]
    return any(not isinstance(part, str) for text in texts for part in split_template(text))


def _used(draft: ProjectDraft, main: DocumentReport, walked: set[str]) -> None:
    assert draft.settings
    if _computed(draft):
        return
    for name in draft.settings.section(HallPlaces).by_name:
        if name not in walked:
            hint = f"write `walk: {{to: {name}}}` in a behaviour, or delete the place"
            main(UNUSED_PLACE, ("places", name), f"no walk leads to the place `{name}`", hint, key=True)


def _on_stage(main: DocumentReport, name: str, place: HallPlace, stage: Stage) -> None:
    for axis, at, (low, high) in (("x", place.x, stage.x), ("y", place.y, stage.y)):
        if not low + SOLE_REACH - 1e-9 <= at <= high - SOLE_REACH + 1e-9:
            beyond = (
                "is too close to the edge of the stage: a foot would step off it"
                if low <= at <= high
                else "is off the stage"
            )
            room = f"[{low + SOLE_REACH:.3g}, {high - SOLE_REACH:.3g}]"
            hint = (
                f"choose {axis} in {room} m, because the soles extend {SOLE_REACH:g} m from the point between the feet;"
                " or enlarge the `stage`"
            )
            related = [(("stage", axis), "the stage ends here")]
            main(PLACE_OFF_STAGE, ("places", name, axis), f"`{name}` {beyond}", hint, related=related)


def _apart(main: DocumentReport, places: Iterable[tuple[str, HallPlace]]) -> None:
    """Report pairs of places so close that the robot can be at both."""
    for (one, a), (other, b) in combinations(places, 2):
        apart = hypot(a.x - b.x, a.y - b.y)
        if apart < a.within + b.within - 1e-9:
            message = f"`{other}` is {apart:.2f} m from `{one}`: the robot could be at both at once"
            hint = f"put them at least {a.within + b.within:.2f} m apart, or write a smaller `within` for each"
            related = [(("places", one), "the other one is here")]
            main(PLACES_TOO_CLOSE, ("places", other), message, hint, key=True, related=related)


def _heading(main: DocumentReport, name: str) -> None:
    """Report a heading that is implausible in the file's unit."""
    heading, unit = main.document.find(("places", name, "heading")), main.document.find(("units", "angle")) or "deg"
    if not isinstance(heading, int | float):
        return
    path = ("places", name, "heading")
    if unit == "deg" and round(abs(heading), 4) in HALF_TURN_PARTS:
        hint = f"write {round(heading * 180 / pi):g}"
        main(WRONG_UNIT, path, f"{heading:g} deg is very small: it looks like a value in radians", hint)
    elif abs(heading) > (360.0 if unit == "deg" else 2 * pi + 0.01):
        hint = (
            "write at most one full turn"
            if unit == "deg"
            else "delete `angle: rad` from `units`: headings are usually in degrees"
        )
        main(WRONG_UNIT, path, f"{heading:g} {unit} is more than a full turn", hint)
