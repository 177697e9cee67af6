"""Tests are marked by the names they use, also through helpers; the functions here are only analysed, never called."""

from collections.abc import Iterator
from functools import cache
from typing import Any

import mujoco
import pytest
from hypothesis import given, strategies

from lumen.features.simulation.offers import SimulatedRobot
from tests.fetched import fetched
from tests.marking import REAL_TIMEOUT, marks
from tests.rabbitmq import RabbitMQ


def starts() -> RabbitMQ:
    return RabbitMQ()


def in_a_function_within() -> Iterator[Any]:
    yield lambda: [starts() for _ in range(2)]


@cache
def remembered() -> object:
    return mujoco.MjSpec()


@given(strategies.integers())
def property_of(number: int) -> None:
    assert fetched(str(number))


class Stand:
    def __init__(self, robot: object) -> None:
        self.robot = robot

    @property
    def another(self) -> object:
        return SimulatedRobot

    @classmethod
    def make(cls) -> "Stand":
        return cls(remembered())


def by_name_only(robot: SimulatedRobot, broker: RabbitMQ) -> object:
    """Annotations need nothing: the robot may be the recording one in a test of everything."""
    return robot or broker


def everything() -> object:
    return Stand, starts, property_of


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("starts", "broker own servers"),
        ("in_a_function_within", "broker own servers"),
        ("remembered", "physics"),
        ("property_of", "npm"),
        ("Stand", "physics"),
        ("by_name_only", ""),
        ("everything", "broker npm own servers physics"),
    ],
)
def test_marks_come_from_what_is_named(name: str, expected: str) -> None:
    assert " ".join(sorted(marks(globals()[name]))) == expected


@pytest.mark.parametrize("name", ["starts"])
def test_and_not_from_strings(name: str, request: pytest.FixtureRequest) -> None:
    """A name in a string marks no test, or this one would need a broker."""
    assert {mark.name for mark in request.node.iter_markers()} <= {"parametrize", "xdist_group"}


@pytest.mark.xdist_group("one")
def test_workers_are_told_of_groups(request: pytest.FixtureRequest) -> None:
    """If ids of tests could not be changed, groups would be ignored silently, and several brokers would run at once."""
    assert request.node.nodeid.endswith("@one") == request.config.getoption("loadgroup", False)


@pytest.mark.process
def test_a_real_test_may_take_longer(request: pytest.FixtureRequest) -> None:
    timeout = request.node.get_closest_marker("timeout")
    assert timeout is not None
    assert timeout.args == (REAL_TIMEOUT,)
