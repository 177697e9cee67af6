"""Each robot performs a verb of a package, ends it at a stop, and refuses one that moves it while it rests."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import lumen
from lumen.language.commands import Do, Rest, Stop
from lumen.language.events import RESULT, Event
from tests.seams.test_robot import ROBOTS, Body
from tests.waiting import until


@pytest.fixture(params=ROBOTS.values(), ids=list(ROBOTS))
def robot(request: pytest.FixtureRequest, project: Path) -> Iterator[Body]:
    body: Body = request.param(lumen.load(project))
    yield body
    body.close()


def answer(robot: Body, id: str) -> Event:
    """Let the robot live until that command is answered, and return the answer."""
    events: list[Event] = []

    def live() -> bool:
        robot.advance(0.1)
        events.extend(event for event in robot.poll() if event.name.endswith(f".command.{id}"))
        return bool(events)

    until(live, every=0.0)
    return events[0]


def test_it_is_performed_with_a_result(robot: Body) -> None:
    robot.start("d1", Do("blink", {"times": 2}))
    assert answer(robot, "d1")[:2] == ("done.command.d1", {RESULT: {"blinked": 2}})
    assert "d1" in robot.begun()


def test_what_does_not_fit_its_row_is_an_answer_and_no_exception(robot: Body) -> None:
    robot.start("d1", Do("blink", {"times": "two"}))
    robot.start("d2", Do("blnk"))
    assert answer(robot, "d1").data["reason"].startswith("`blink`: `times` should be a whole number")
    robot.start("d3", Do("blnk"))
    assert answer(robot, "d3").data["reason"].startswith("no feature here has a verb `blnk`")


def test_a_stop_ends_it(robot: Body) -> None:
    robot.start("d1", Do("hum"))
    robot.advance(0.02)
    robot.start("stop", Stop())
    assert answer(robot, "d1").name == "cancelled.command.d1"


def test_one_that_moves_the_robot_is_refused_while_it_rests(robot: Body) -> None:
    robot.start("rest", Rest())
    assert answer(robot, "rest").name == "done.command.rest"
    robot.start("d1", Do("wiggle"))
    robot.start("d2", Do("blink", {"times": 1}))
    assert answer(robot, "d1")[:2] == (
        "error.command.d1",
        {"reason": "the robot rests or has fallen: `wake` it first"},
    )
    robot.start("d3", Do("blink", {"times": 1}))
    assert answer(robot, "d3").name == "done.command.d3"
