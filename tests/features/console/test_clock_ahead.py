"""The offset of an exhibition's clock: pages receive it once, apply it, and receive it again only if it changes."""

from datetime import UTC, datetime, timedelta

import pytest

from lumen.features.console.known_robot import KnownRobot


def at(ahead: float) -> str:
    return (datetime.now(UTC) + timedelta(seconds=ahead)).isoformat()


@pytest.mark.parametrize("ahead", [0.0, 3600.0, -86_400.0 * 200])
def test_it_is_the_distance_of_the_clocks(ahead: float) -> None:
    robot = KnownRobot("NAO")
    robot.answered({"robot": "NAO", "time": at(ahead)})
    assert robot.to_json(full=True)["ahead"] == pytest.approx(ahead, abs=1.0)


def test_an_answer_that_says_the_same_later_is_no_news() -> None:
    robot = KnownRobot("NAO")
    robot.answered({"robot": "NAO", "time": at(3600.0)})
    seen = robot.version
    robot.answered({"robot": "NAO", "time": at(3600.2)})
    assert robot.version == seen
    robot.answered({"robot": "NAO", "time": at(7200.0)})
    assert robot.version == seen + 1


@pytest.mark.parametrize("told", [None, "noon", 5, "9999-99-99T00:00:00Z"])
def test_what_is_no_time_is_not_believed(told: object) -> None:
    robot = KnownRobot("NAO")
    robot.answered({"robot": "NAO", "time": told})
    assert robot.to_json(full=True)["ahead"] == 0.0
