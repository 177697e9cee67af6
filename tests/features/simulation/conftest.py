"""A NAO on its stage."""

from collections.abc import Callable, Sequence

import pytest

import lumen
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.motion.projection import centring
from lumen.ports import RobotCommand
from tests import ROOT

MODELS = ROOT / "models"


@pytest.fixture(scope="session")
def body() -> Body:
    return lumen.load(MODELS.parent).body


@pytest.fixture
def robot(body: Body) -> SimulatedRobot:
    return SimulatedRobot(body, MODELS, "hall.xml")


Do = Callable[[RobotCommand], str]


@pytest.fixture
def do(robot: SimulatedRobot) -> Do:
    """Return a function that performs a command to its end; it returns the name of the answer, and the reason of an
    error.
    """

    def perform(command: RobotCommand) -> str:
        robot.start("x", command)
        return answer(until_answered(robot, "x"), "x")

    return perform


def until_answered(robot: SimulatedRobot, id: str, limit: float = 60.0) -> list[Event]:
    """Let the robot live until that command is answered, at most `limit` [s]; return all its events."""
    events: list[Event] = []
    end = robot.time + limit
    while not answer(events, id):
        assert robot.time < end, f"no answer within {limit} s"
        robot.advance(0.02)
        events += robot.poll()
    return events


def answer(events: Sequence[Event], id: str) -> str:
    """Return the command's `done`, `cancelled` or `error: REASON`, or an empty string if no answer came."""
    for event in events:
        kind, _, rest = event.name.partition(".command.")
        if rest == id:
            return f"{kind}: {event.data['reason']}" if kind == "error" else kind
    return ""


def look_at_face(robot: SimulatedRobot, do: Do, body: Body) -> None:
    """Turn the head so that the visitor's face should be in the middle of the image."""
    robot.advance(0.2)
    torso = robot.world.data.body("nao/Torso")
    face = robot.world.data.site("visitor_face").xpos
    x, y, z = torso.xmat.reshape(3, 3).T @ (face - torso.xpos)
    yaw, pitch = centring((float(x), float(y), float(z)), body.camera)
    assert do(Look(yaw, pitch)) == "done"
    robot.advance(0.5)
