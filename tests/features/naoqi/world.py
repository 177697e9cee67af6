"""The shared state of the fake NAOqi's services: time, joints, recorded calls, and faults that a test can set."""

from typing import Any

from lumen.features.naoqi.hardware import hardware_of
from tests.features.naoqi.joints import Joints
from tests.features.naoqi.times import Times


class World:
    """The services' shared state: time, joints, recorded calls, and faults that a test can set."""

    def __init__(self, body: Any) -> None:
        self.times = Times()
        self.joints = Joints(body, self.times)
        self.body, self.hardware = body, hardware_of(body)
        self.asked: set[str] = set()
        self.calls: list[tuple[float, str, tuple[Any, ...]]] = []
        self.awake, self.family, self.stiffness = True, "Standing", 1.0
        self.position = [0.0, 0.0, 0.0]
        self.obstacle = self.deaf = self.astray = False
        self.version = "2.8.6.23"
        self.pressed: set[str] = set()
        self.sonar = (2.55, 2.55)
        self.charge, self.plugged, self.charging = 1.0, False, False
        self.temperatures: dict[str, float] = {}
        self.size = (320, 240)
        self.voices = ["English", "French"]
        self.sounds: set[str] = set()
        self.life = "solitary"
        self.sound = bytes(range(256)) * 400
        self.listens = True
        self.lacks: set[str] = set()
        self.silent: set[str] = set()

    def note(self, method: str, *arguments: Any) -> None:
        self.calls.append((self.times.now, method, arguments))

    def called(self, method: str) -> list[tuple[Any, ...]]:
        """Return the arguments of each call of that method."""
        return [arguments for _, name, arguments in self.calls if name == method]
