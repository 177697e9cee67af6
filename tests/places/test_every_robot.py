"""Each robot reports its estimated place, and is led to a place by it; its report is compared with the truth."""

from collections.abc import Callable, Iterator
from math import hypot

import pytest

from lumen.features.simulation.odometry import DRIFT_AFTER_SITTING
from lumen.language.commands import Posture
from lumen.language.events import Event
from lumen.language.hall_places import HallPlace, HallPlaces
from lumen.language.projects import Project
from lumen.language.robots import Body as RobotBody
from lumen.motion.wayfinding import turned
from lumen.ports import Joints, Robot, Sense, Whereabouts
from lumen.run.navigator import Navigator
from tests.features.simulation.conftest import body
from tests.features.simulation.walks import any_robot, truth
from tests.seams.test_robot import ROBOTS, Body
from tests.tour.conftest import project

__all__ = ["body", "project"]

ORGAN = HallPlace(0.2, -0.1, 0.4, within=0.15)


@pytest.fixture(params=ROBOTS.values(), ids=list(ROBOTS))
def robot(request: pytest.FixtureRequest, project: Project) -> Iterator[Body]:
    one = request.param(project)
    yield one
    one.close()


def where(robot: Robot) -> Whereabouts:
    reading = robot.read(Sense.JOINT)
    assert isinstance(reading, Joints)
    assert reading.position
    return reading.position


def led(robot: Body, project: Project, name: str, most: float, also: Callable[[], None] = lambda: None) -> list[Event]:
    """Return all events until the walk to that place is answered, including the answer."""
    navigator = Navigator(robot, lambda id, command, now: robot.start(id, command))
    navigator.start("d1", name, 0.0)
    events: list[Event] = []
    now = 0.0
    while now < most and not (events and events[-1].name.endswith(".command.d1")):
        robot.advance(0.02)
        now += 0.02
        also()
        events += navigator.tick(project, "", robot.poll(), now)
    return [event for event in events if event.name in ("arrived", "left") or "command" in event.name]


def test_it_is_led_to_a_place(robot: Body, project: Project) -> None:
    for _ in range(20):
        robot.advance(0.02)
        robot.poll()
    assert where(robot) == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=0.01)
    events = led(robot, project.with_section("places", HallPlaces({"organ": ORGAN})), "organ", 60.0)
    assert [event.name for event in events] == ["arrived", "done.command.d1"]
    here = where(robot)
    assert hypot(here.x - ORGAN.x, here.y - ORGAN.y) <= 0.1
    assert abs(turned(here.theta, ORGAN.heading or 0.0)) <= 0.2
    assert events[0].data == {"place": "organ", "doubt": pytest.approx(here.doubt, abs=0.002)}
    assert 0.0 < here.doubt < ORGAN.within


@pytest.mark.parametrize("seed", [1, pytest.param(4, marks=pytest.mark.soak)])
def test_between_two_places_a_metre_apart_it_is_where_it_claims_to_be(
    body: RobotBody, project: Project, seed: int
) -> None:
    robot = any_robot(body, seed)
    places = {"organ": HallPlace(0.5, 0.3), "clock": HallPlace(-0.5, 0.3, 0.0)}
    for name in ("organ", "clock"):
        events = led(robot, project.with_section("places", HallPlaces(places)), name, 120.0)
        assert [event.name for event in events] == ["arrived", "done.command.d1"]
        claimed, place, real = where(robot), places[name], truth(robot)
        assert hypot(real.x - claimed.x, real.y - claimed.y) <= claimed.doubt
        assert hypot(real.x - place.x, real.y - place.y) <= claimed.doubt + 0.05
        assert events[0].data["doubt"] == pytest.approx(claimed.doubt, abs=0.002)
        assert claimed.doubt < place.within


def test_a_robot_that_sat_knows_its_place_less_well(body: RobotBody, project: Project) -> None:
    robot = any_robot(body, 2)
    before = where(robot)
    robot.start("p", Posture("Sit"))
    for _ in range(1500):
        robot.advance(0.02)
        if any(event.name == "done.command.p" for event in robot.poll()):
            break
    assert where(robot).doubt >= before.doubt + DRIFT_AFTER_SITTING
