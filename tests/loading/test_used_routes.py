"""A route that comes with Lumen holds without a row, if a behaviour hears its event or publishes to it."""

from pathlib import Path
from textwrap import dedent

import pytest

import lumen
from lumen.bus.aliases import aliases_of
from lumen.bus.validated import by_key
from lumen.features.formats_routes.asyncapi import document
from lumen.insight.changes.projects import changes
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.building import draft
from lumen.project.chosen_robot import as_robot
from lumen.project.draft import ProjectDraft
from tests import ROOT
from tests.tables import for_each

SHIPPED = ROOT
MAIN = "behavior: host\nlanguages: [en]\nrobot: {model: nao}\nhall: hall.xml\n"
HOUSE = """\
behavior: host
languages: [en]
robots: {ana: {model: nao, at: {y: -1}}, ben: {model: nao, at: {y: 1}}}
hall: hall.xml
"""
HEARS = "states: {idle: {on: {face: idle}}}\n"
NOTHING = "states: {idle: {on: {touched: idle}}}\n"
PUBLISHES = "states: {idle: {on: {touched: {actions: {publish: {route: %s, body: \"'Hello'\"}}}}}}\n"
ROW = "routes:\n  %s: {key: %s, direction: in, event: %s}\n"
FACE = """\
routes:
  face:
    key: "lumen.{robot}.visual.face.detection"
    alias: lumen.visual.face.detection
    direction: in
    schema: face.detection
    event: face
    ttl: 1s
    keep: 1
"""
THRESHOLD = """\
inputs: {Near: {range: [0, 1], terms: {Yes: {gaussian: [0, 1]}}}}
outputs: {Mood: {range: [0, 1], default: 0, terms: {Good: {gaussian: [1, 1]}}}}
rules: [if Near is Yes then Mood is Good]
bind: {inputs: {Near: context.near}, outputs: {Mood: {event: face, above: 0.5}}}
"""


def files(behavior: str, rows: str = "", **more: str) -> dict[str, bytes]:
    """Return the files of a project whose lumen.yaml has these rows; `more` are behaviours and controllers by name."""
    texts = {"lumen.yaml": MAIN + rows, "behaviors/host.yaml": dedent(behavior)}
    texts |= {f"{'fuzzy' if text is THRESHOLD else 'behaviors'}/{name}.yaml": text for name, text in more.items()}
    return {name: text.encode() for name, text in texts.items()}


def built_in(found: ProjectDraft) -> set[str]:
    """Return the names of the routes that hold without a row."""
    assert found.settings
    return {name for name, route in found.settings.routes.items() if route.built_in}


def sound(given: dict[str, bytes]) -> Project:
    """Return the project of files with which nothing is wrong."""
    project, found = check_files(Path(), given)
    assert project, found
    assert not found
    return project


@for_each(
    ("behavior", "found"),
    [
        ("states: {idle: {on: {face: idle, heard: idle}}}\n", {"face", "heard"}),
        ("states: {idle: {on: {face.*: idle}}}\n", {"face"}),
        ("on: {recognised: .idle}\nstates: {idle: {states: {in: {on: {gender: in}}}}}\n", {"recognised", "gender"}),
        ("states: {idle: {on: {'*': idle}}}\n", set()),
        ("states: {idle: {on: {face.lost: idle, faces: idle, touched: idle}}}\n", set()),
        ("states: {idle: {do: {say: Hello}, onDone: idle, after: {3s: idle}}}\n", set()),
        (PUBLISHES % "visual_command", {"visual_command"}),
        ("states: {idle: {entry: {if: 'true', then: {publish: {route: trouble}}}}}\n", {"trouble"}),
        (
            "states: {idle: {do: {parallel: [{publish: {route: text_stream}}, {publish: {route: fact}}]}}}\n",
            {"text_stream", "fact"},
        ),
    ],
)
def test_those_that_a_behaviour_uses_hold(behavior: str, found: set[str]) -> None:
    assert built_in(draft(files(behavior))) == found


@for_each(
    ("behavior", "rows", "more"),
    [
        (HEARS, "routes:\n  face: null\n", {}),
        (HEARS, "routes:\n  face:\n", {}),
        (HEARS, ROW % ("face", "museum.face", "face"), {}),
        (HEARS, ROW % ("face", "museum.face", "seen"), {}),
        (HEARS, ROW % ("eyes", "museum.face", "face"), {}),
        (HEARS, ROW % ("eyes", '"lumen.{robot}.visual.face.detection"', "seen"), {}),
        (HEARS, ROW % ("eyes", "lumen.NAO.visual.face.detection", "seen"), {}),
        (HEARS, ROW % ("eyes", "lumen.visual.face.detection", "seen"), {}),
        (HEARS, "routes:\n  face: {key: museum.face, direction: inward}\n", {}),
        (f"events: {{face: null}}\n{HEARS}", "", {}),
        ("states: {idle: {on: {face: idle, touched: {actions: {raise: face}}}}}\n", "", {}),
        ("states: {idle: {entry: {send: {event: face, delay: 1s}}, on: {face: idle}}}\n", "", {}),
        (HEARS, "", {"other": "states: {a: {entry: {send: {event: face, to: parent}}}}\n"}),
        ("states: {idle: {buttons: [{label: Look, event: face}], on: {face: idle}}}\n", "", {}),
        (f"context: {{near: 0}}\n{HEARS}", "", {"mood": THRESHOLD}),
    ],
)
def test_what_the_project_says_itself_wins(behavior: str, rows: str, more: dict[str, str]) -> None:
    assert built_in(draft(files(HEARS))) == {"face"}
    assert built_in(draft(files(behavior, rows, **more))) == set()


def test_every_one_is_a_row_of_the_tour() -> None:
    """Only `get_wave` is the tour's own: Lumen and its modules send nothing under it."""
    routes = lumen.load(SHIPPED).routes
    assert {name: route for name, route in routes.items() if name != "get_wave"} == BUILT_IN_ROUTES
    assert not any(route.built_in for route in routes.values())
    for route in BUILT_IN_ROUTES.values():
        assert route.must_arrive == routes[route.name].must_arrive


def test_a_first_file_needs_no_row() -> None:
    project = sound(
        files("states: {idle: {on: {face: idle, heard: {guard: event.data.result == 'hi', target: idle}}}}\n")
    )
    assert project.routes == {name: BUILT_IN_ROUTES[name] for name in ("heard", "face")}
    assert set(project.messages) == {"face.detection", "speech.recognition"}
    assert [use.file for use in project.routes["face"].uses] == ["behaviors/host.yaml"]
    assert by_key(project).keys() >= {"lumen.NAO.visual.face.detection", "lumen.visual.face.detection"}
    assert document(project)["channels"].keys() == {"heard", "heard.alias", "face", "face.alias"}


def test_its_uses_are_those_of_each_behaviour() -> None:
    host = "states:\n  idle: {invoke: {behavior: quiz}, on: {heard: idle}}\n"
    quiz = "states:\n  ask:\n    on:\n      heard.*: {actions: {publish: {route: heard}}}\n      gender: ask\n"
    project = check_files(Path(), files(host, quiz=quiz))[0]
    assert project
    uses = [(use.verb, project.place(use.file, use.where)) for use in project.routes["heard"].uses]
    assert [(verb, place.file, place.line) for verb, place in uses] == [
        ("hears", "behaviors/host.yaml", 2),
        ("hears", "behaviors/quiz.yaml", 4),
        ("publishes to", "behaviors/quiz.yaml", 4),
    ]


@pytest.mark.parametrize("robot", ["ana", "ben"])
def test_each_robot_of_a_house_has_its_own(robot: str) -> None:
    given = {**files(HEARS), "lumen.yaml": HOUSE.encode()}
    project = sound(as_robot(given, robot))
    assert project.key_of("face") == f"lumen.{robot}.visual.face.detection"
    assert by_key(project).keys() == {f"lumen.{robot}.visual.face.detection"}
    assert aliases_of(project) == {}


def test_a_saved_behaviour_that_uses_another_is_told_with_its_file() -> None:
    before, after = sound(files(NOTHING)), sound(files(PUBLISHES % "text_stream"))
    told = [(change.file, change.sentence) for change in changes(before, after) if change.kind == "route"]
    assert told == [("behaviors/host.yaml", "route `text_stream` added")]
    written = sound(files(HEARS, FACE))
    assert (written.routes["face"].built_in, written.routes["face"].where) == (False, ("routes", "face"))
    assert [change for change in changes(sound(files(HEARS)), written) if change.kind == "route"] == []
