"""A server with a puppet for a robot, and a module that gives it commands."""

import threading
from collections.abc import Sequence
from typing import Any

import numpy as np

from lumen.bus import Bus, connect
from lumen.language.events import Event
from lumen.ports import Battery, Image, Joints, Reading, RobotCommand, Sense, Sonar, Tactile
from lumen.robot.command_receiver import CommandListener
from lumen.robot.server import RobotServer
from tests.exhibits import JOINTS, TACTILE, project
from tests.waiting import HANG, Collector

PROJECT = project()
NAMES = tuple(JOINTS)
FRAME = np.zeros((240, 320, 3), np.uint8)
PATIENT = HANG
DATE = "2015-06-01T09:30:00.000+00:00"


class Puppet:
    """A robot whose answers and readings a test sets."""

    def __init__(self) -> None:
        self.now = 0.0
        self.started: list[tuple[str, RobotCommand]] = []
        self.reads: list[Sense] = []
        self.pixels: Any = lambda: FRAME

    def start(self, id: str, command: RobotCommand) -> None:
        self.started.append((id, command))

    def cancel(self, id: str) -> None: ...

    def poll(self) -> Sequence[Event]:
        return ()

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        self.reads.append(sense)
        match sense:
            case Sense.IMAGE:
                return Image(self.now, self.pixels)
            case Sense.JOINT:
                return Joints(self.now, NAMES, (0.1,) * len(NAMES), (1.0,) * len(NAMES))
            case Sense.SONAR:
                return Sonar(self.now, left=0.5, right=2.55)
            case Sense.TACTILE:
                return Tactile(self.now, TACTILE, (1,) + (0,) * 11)
            case Sense.BATTERY:
                return Battery(self.now, 80, plugged=False, charging=True)

    def close(self) -> None: ...


class Stand:
    """A server with its puppet, its bus, and all messages on it."""

    def __init__(
        self, bus: Bus | None = None, *listeners: CommandListener, direct: bool = False, **changes: Any
    ) -> None:
        self.robot, self.bus, self.heard = Puppet(), bus or connect("memory://"), Collector()
        self.bus.subscribe("avatar.NAO.data.#", self.heard)
        self.clock = 0.0
        self.server = RobotServer(
            project(**changes),
            self.robot,
            self.bus,
            date=lambda: DATE,
            clock=lambda: self.clock,
            listeners=listeners,
            direct=direct,
        )

    def live(self, seconds: float, tick: float = 0.02) -> None:
        for i in range(round(seconds / tick)):
            self.robot.now = i * tick
            self.server.sample(self.robot.now)
            assert self.server.settle(PATIENT)

    def publish(self, key: str, body: Any, **options: Any) -> None:
        """Publish a message, and wait until it has arrived."""
        self.bus.publish(key, body, **options)
        delivered(self.bus)

    def of(self, sense: str) -> list[Any]:
        delivered(self.bus)
        return [m.body for m in list(self.heard.messages) if m.key == f"avatar.NAO.data.{sense}"]


def delivered(bus: Bus) -> None:
    """Wait until all that was published has arrived: a thread that is delivering also delivers for the others."""
    arrived = threading.Event()
    undo = bus.subscribe("lumen.test.mark", lambda _: arrived.set())
    bus.publish("lumen.test.mark", None)
    assert arrived.wait(HANG)
    undo()


def without(*senses: str) -> dict[str, Any]:
    return {"routes": {name: route for name, route in PROJECT.routes.items() if name not in senses}}


class Caller:
    """A module that gives commands and waits for answers."""

    def __init__(self, stand: Stand) -> None:
        self.stand, self.answers = stand, Collector()
        stand.bus.subscribe("lumen.me", self.answers)

    def order(self, method: str, id: str = "7", **parameter: Any) -> None:
        body = {"type": "motion", "Method": method, "parameter": parameter}
        self.stand.publish("avatar.NAO.command", body, reply_to="lumen.me", correlation_id=id)

    @property
    def told(self) -> list[tuple[str, str]]:
        delivered(self.stand.bus)
        return [(m.correlation_id, m.body) for m in self.answers.messages]
