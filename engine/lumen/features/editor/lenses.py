"""Lenses: clickable lines above the text, to run a story, play a motion, or show the transitions to a state."""

from collections.abc import Collection, Iterator
from typing import NamedTuple

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.index import stem
from lumen.language.diagnostics import Place
from lumen.project.project_folders import kind_of

RUN_STORY, PLAY_MOTION, SHOW_PLACES = "lumen.runStory", "lumen.playMotion", "lumen.showPlaces"
"""The commands of the lenses."""
ACTIVE_NOW = "● active now"


class Lens(NamedTuple):
    """A title that is shown above a place in the file."""

    place: Place
    title: str
    command: str = ""
    """The name of the editor's command for a click; empty if there is none."""
    name: str = ""
    """The name of the story, motion or state; empty for an active state."""
    places: tuple[Place, ...] = ()
    """The places of the transitions to the state; empty for other lenses."""


def lenses(analysis: Analysis, file: str, active: Collection[str] = ()) -> Iterator[Lens]:
    """Yield a file's lenses; `active` are the names of the active states in the project's running exhibition."""
    top = Place(file)
    match kind_of(file):
        case "story":
            yield Lens(top, "run this story", RUN_STORY, stem(file))
        case "motion" if file.startswith("motions/"):
            yield Lens(top, "play this motion", PLAY_MOTION, stem(file))
        case "behavior":
            yield from _states(analysis, file, active)


def active_places(analysis: Analysis, active: Collection[str]) -> list[Place]:
    """Return the places that define the active states in the behaviour that the project runs."""
    settings = analysis.settings.settings
    file = f"behaviors/{settings.behavior}.yaml" if settings else ""
    return [each.place for each in lenses(analysis, file, active) if each.title == ACTIVE_NOW]


def _states(analysis: Analysis, file: str, active: Collection[str]) -> Iterator[Lens]:
    document, machine = analysis.documents.get(file), analysis.draft.behaviors.get(stem(file))
    if document is None or machine is None:
        return
    ways: dict[str, list[Place]] = {}
    for state in machine.states.values():
        for transition in state.transitions:
            for target in transition.targets:
                ways.setdefault(target, []).append(document.place(transition.where))
    for state in machine.states.values():
        if state.path and document.spans.get(state.where):
            place = document.place(state.where, key=True)
            if state.name in active:
                yield Lens(place, ACTIVE_NOW)
            if found := tuple(dict.fromkeys(ways.get(state.path, ()))):
                title = "1 transition leads here" if len(found) == 1 else f"{len(found)} transitions lead here"
                yield Lens(place, title, SHOW_PLACES, state.name, found)
