"""The pure part of walking to a place: the choice of the next walk, and the robot's position."""

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.commands import Walk
from lumen.language.hall_places import HallPlace
from lumen.motion.wayfinding import FACING, NEAR, DeadReckoning, beyond, most_legs, next_leg, place_at, turned
from lumen.ports import Whereabouts

METRES, TURNS = st.floats(-8, 8), st.floats(-pi, pi)


@given(METRES, METRES, TURNS, METRES, METRES, st.none() | TURNS)
def test_the_walks_lead_there_within_their_number(
    x: float, y: float, theta: float, to_x: float, to_y: float, heading: float | None
) -> None:
    here, place = Whereabouts(x, y, theta), HallPlace(to_x, to_y, heading)
    for _ in range(most_legs(here, place)):
        leg = next_leg(here, place)
        if leg is None:
            break
        here = Whereabouts(*beyond(here, leg.x, leg.y, leg.theta))
    assert next_leg(here, place) is None
    assert abs(complex(here.x - to_x, here.y - to_y)) <= NEAR
    assert heading is None or abs(turned(here.theta, heading)) <= FACING


def test_it_turns_before_it_walks_far_and_not_before_a_step_aside() -> None:
    assert next_leg(Whereabouts(), HallPlace(0.0, 1.0)) == Walk(theta=pytest.approx(pi / 2))
    assert next_leg(Whereabouts(), HallPlace(0.0, 0.2, 0.5)) == Walk(0.0, 0.2, 0.5)


def test_it_walks_no_more_than_two_metres_at_once() -> None:
    assert next_leg(Whereabouts(), HallPlace(5.0, 0.0)) == Walk(2.0, 0.0)


def test_at_a_place_until_it_is_left() -> None:
    places = {"organ": HallPlace(1.0, 0.0, within=0.2), "clock": HallPlace(1.3, 0.0, within=0.2)}
    assert place_at(Whereabouts(0.7, 0.0), places, "") == ""
    assert place_at(Whereabouts(0.85, 0.0), places, "") == "organ"
    assert place_at(Whereabouts(1.18, 0.0), places, "") == "clock"
    assert place_at(Whereabouts(1.18, 0.0), places, "organ") == "organ"
    assert place_at(Whereabouts(1.25, 0.0), places, "organ") == "clock"
    assert place_at(Whereabouts(0.77, 0.0), places, "organ") == "organ"
    assert place_at(Whereabouts(0.77, 0.0), {}, "organ") == ""


def test_doubt_grows_with_the_way_and_stays_when_it_comes_back() -> None:
    robot, doubts = DeadReckoning(), []
    for x in (1.0, 2.0, 3.0, 0.0):
        robot.follow(x, 0.0, 0.0)
        doubts.append(robot.whereabouts.doubt)
    assert 0.02 < doubts[0] < 0.06
    assert doubts == sorted(doubts)
    assert doubts[2] > 3**0.5 * doubts[0]  # heading is uncertain, too
    robot.slid = 0.6
    assert robot.whereabouts.doubt == pytest.approx(doubts[-1] + 0.6)


def test_looking_more_often_changes_the_doubt_by_little() -> None:
    once, often = DeadReckoning(), DeadReckoning()
    for i in range(1, 101):
        often.follow(i / 50, 0.0, 0.0)
    for i in range(1, 9):
        once.follow(i / 4, 0.0, 0.0)
    assert often.whereabouts.doubt == pytest.approx(once.whereabouts.doubt, rel=0.15)
