"""The guide of examples/museum: its stories, its page, and a visit with physics."""

import re
from dataclasses import replace
from math import dist

import pytest

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Command, Publish, Start, Volume
from lumen.language.events import Event
from lumen.language.hall_places import HallPlaces
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.lending import model_files
from lumen.run.exploring import explored
from lumen.run.loop import Observer
from lumen.run.rehearsal import rehearse
from lumen.run.setup import Setup
from lumen.statechart import Step
from tests import ROOT
from tests.scanning import matching
from tests.tour.playing import play

MUSEUM = ROOT / "examples/museum"
PAGE = (ROOT / "docs/museum.md").read_text("utf-8")
TORSO = 0.01
"""The distance of the torso ahead of the feet [m]."""
EXHIBITS = ["clock", "organ", "globe", "telescope", "loom"]


@pytest.fixture(scope="module")
def museum() -> Project:
    return lumen.load(MUSEUM)


def test_nothing_is_wrong_with_it() -> None:
    assert check_files(MUSEUM, read_files(MUSEUM))[1] == ()


@pytest.mark.parametrize("name", sorted(path.stem for path in matching(MUSEUM, "behaviors/stories/*.yaml")))
def test_the_story_ends_well(museum: Project, name: str) -> None:
    run = play(museum, museum.stories[name])
    assert run.failure == ""
    assert run.errors == []


def test_whatever_happens_nothing_fails(museum: Project) -> None:
    """Explores a thousand configurations; `lumen test examples/museum --explore` explores more."""
    assert explored(museum, "museum", bound=1_000).findings == ()


def test_the_page_shows_what_is_there() -> None:
    """Every line of YAML in docs/museum.md is in a file of the project, in the same order within a block."""
    lines = [line.strip() for file in matching(MUSEUM, "**/*.yaml") for line in file.read_text("utf-8").splitlines()]
    known = {re.sub(r"\s+#.*", "", line) for line in lines}
    blocks = re.findall(r"```yaml\n(.*?)```", PAGE, re.S)
    assert len(blocks) >= 8
    shown = [re.sub(r"\s+#.*", "", line.strip()) for block in blocks for line in block.splitlines()]
    assert [line for line in shown if line not in known] == []


class Watch(Observer):
    """The messages to the lamps, the volumes of the speech, and the robot's reports of arrival."""

    def __init__(self) -> None:
        self.lamps: list[tuple[str, float]] = []
        self.volumes: list[float] = []
        self.arrived: list[tuple[str, float]] = []
        self.texts: list[str] = []

    def stepped(self, step: Step) -> None:
        if step.event and step.event.name == "arrived":
            self.arrived.append((step.event.data["place"], step.event.data["doubt"]))

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Publish("lamp", body):
                self.lamps.append((body["exhibit"], body["brightness"]))
            case Start(_, Volume(level)):
                self.volumes.append(level)

    def answered(self, event: Event) -> None: ...


@pytest.mark.physics
@pytest.mark.soak  # walks between places are in tests/places, a story in physics in tests/tour
@pytest.mark.parametrize(
    ("story", "places", "shown"),
    [
        ("operator", ["clock", "globe"], ["clock", "clock", "organ", "organ", "globe", "globe"]),
        ("visit", EXHIBITS, [name for name in EXHIBITS for _ in range(2)]),
    ],
)
def test_a_visit_at_honest_physics(museum: Project, story: str, places: list[str], shown: list[str]) -> None:
    """It walks to each exhibit, is at most as far off as it reports, never falls, and returns to the door."""
    blind = replace(museum, routes={name: route for name, route in museum.routes.items() if name != "image"})
    models, hall = model_files(museum)
    robot = SimulatedRobot(museum.body, models, hall, stage=museum.stage)
    watch, off = Watch(), list[tuple[str, float, float]]()

    def measure(now: float) -> None:
        if len(watch.arrived) > len(off):
            name, doubt = watch.arrived[-1]
            place = museum.section(HallPlaces).by_name[name]
            x, y = robot.world.data.xpos[robot.world.torso][:2]
            off.append((name, dist((x, y), (place.x, place.y)), doubt))

    setup = Setup(robot, SimulatedClock(robot.advance), robot)
    rehearsal = rehearse(blind, museum.stories[story], setup, observers=[watch], hooks=[measure])
    robot.close()
    assert str(rehearsal.failed or "") == ""
    assert [name for name, *_ in off] == ["door", *places, "door"]
    assert all(error < doubt + TORSO for _, error, doubt in off), off
    assert not robot.fallen
    assert robot.greatest_tilt < 15.0
    assert [name for name, _ in watch.lamps] == shown
    assert [level for name, level in watch.lamps if name in places] == [1, 0.2] * len(places)
    assert min(watch.volumes) < 0.7 < max(watch.volumes)
