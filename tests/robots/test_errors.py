"""Each reason why a robot is unusable or fails has its own class, so it can be caught alone."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import nan
from typing import Any

import pytest

from lumen.errors import (
    BadCommandError,
    RobotError,
    RobotFailedError,
    RobotLostError,
    RobotModelError,
    RobotRefusedError,
    RobotUnreachableError,
    SenseError,
)
from lumen.features.naoqi.offers import NaoqiRobot
from lumen.features.naoqi.sensors import NaoqiSensors
from lumen.features.naoqi.session import NaoqiSession
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Posture, Rest, Walk
from lumen.language.projects import Project
from lumen.ports import RobotCommand, Whereabouts
from lumen.robot.command_codec import decode_command
from tests import ROOT
from tests.features.naoqi.fake import FakeNao
from tests.tables import for_each
from tests.tour.conftest import project

__all__ = ["project"]


def naoqi(project: Project, url: str) -> None:
    NaoqiRobot(project.body, url, time.monotonic).close()


@contextmanager
def fake(project: Project, **options: Any) -> Iterator[FakeNao]:
    nao = FakeNao(project.body, **options)
    try:
        yield nao
    finally:
        nao.close()


@contextmanager
def session(project: Project) -> Iterator[tuple[FakeNao, NaoqiSession]]:
    """An open session with a fake whose services it has found."""
    with fake(project) as nao:
        one = NaoqiSession(nao.url)
        one.open()
        one.find(["ALMotion", "ALMemory"])
        try:
            yield nao, one
        finally:
            one.close()


def too_old(project: Project) -> None:
    with fake(project, version="1.14.5") as nao:
        naoqi(project, nao.url)


def not_a_nao(project: Project) -> None:
    with fake(project, without=["ALMotion"]) as nao:
        naoqi(project, nao.url)


def lost(project: Project) -> None:
    with session(project) as (nao, one):
        nao.drop()
        one.request("ALMotion", "robotIsWakeUp")


def no_such_service(project: Project) -> None:
    with session(project) as (_, one):
        one.request("ALDance", "dance")


def no_sonars(project: Project) -> None:
    with session(project) as (_, one):
        NaoqiSensors(one, project.body, time.monotonic, lambda _: Whereabouts(), dict).sonar()


def begin(project: Project, command: RobotCommand, *, empty: bool = False, hall: str = "hall.xml") -> None:
    robot = SimulatedRobot(project.body, ROOT / "models", hall)
    if empty:
        robot.condition._energy = 0.0
    try:
        robot._begin(command, robot.time)
    finally:
        robot.close()


def order(project: Project, method: str, **parameter: object) -> None:
    decode_command({"type": "motion", "method": method, "parameter": parameter}, project)


CAUSES: dict[str, tuple[type[RobotError], Callable[[Project], object]]] = {
    "no address of a robot": (RobotUnreachableError, lambda p: naoqi(p, "http://nao.local")),
    "no such host": (RobotUnreachableError, lambda p: naoqi(p, "tcp://robot.invalid")),
    "port closed": (RobotUnreachableError, lambda p: naoqi(p, "tcp://127.0.0.1:1")),
    "NAOqi is not up yet": (RobotUnreachableError, not_a_nao),
    "NAOqi too old": (RobotModelError, too_old),
    "no such hall": (RobotModelError, lambda p: begin(p, Rest(), hall="nowhere.xml")),
    "connection cut": (RobotLostError, lost),
    "a call that NAOqi fails": (RobotFailedError, no_such_service),
    "no sonars": (SenseError, no_sonars),
    "no such method": (BadCommandError, lambda p: order(p, "danse")),
    "no such posture": (BadCommandError, lambda p: begin(p, Posture("Stnd"))),
    "no number": (BadCommandError, lambda p: begin(p, Walk(nan, 0.0, 0.0))),
    "too far": (BadCommandError, lambda p: begin(p, Walk(1_000.0, 0.0, 0.0))),
    "no angles to change": (RobotRefusedError, lambda p: order(p, "changeangle", jointNames="HeadYaw", angles=0.1)),
    "battery empty": (RobotRefusedError, lambda p: begin(p, Walk(0.1, 0.0, 0.0), empty=True)),
}


@for_each("cause", CAUSES)
def test_each_cause_has_its_class(project: Project, cause: str) -> None:
    expected, provoke = CAUSES[cause]
    with pytest.raises(RobotError) as caught:
        provoke(project)
    assert type(caught.value) is expected
    assert "\n" not in str(caught.value)
