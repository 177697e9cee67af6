"""A fake NAO: a NAOqi on this machine, served by qi, and the hall around it."""

from collections.abc import Iterable
from typing import Any

from lumen.features.naoqi.naoqi_events import event_of
from lumen.language.robots import Body
from lumen.language.stories import Visitor
from lumen.motion.projection import seen
from lumen.robot.recording import FACE_HEIGHT_FRACTION, PODIUM_HEIGHT, TORSO_HEIGHT
from tests.features.naoqi.library import demand, qi
from tests.features.naoqi.services import SERVICES, ALAudioDevice, ALMemory, ALSonar, ALVideoDevice
from tests.features.naoqi.world import World


class FakeNao:
    """Answers as a NAO at `url`; `world` is its state, `times` its clock, and `without` names services it lacks."""

    def __init__(self, body: Body, *, without: Iterable[str] = (), version: str = "2.8.6.23", port: int = 0) -> None:
        demand()
        qi.logging.setLevel(qi.logging.FATAL)
        self.world = World(body)
        self.world.version = version
        self.times = self.world.times
        self.memory = ALMemory(self.world)
        self.camera = ALVideoDevice(self.world)
        self._own: dict[type, Any] = {ALMemory: self.memory, ALVideoDevice: self.camera}
        self._without = tuple(without)
        self._visitor: Visitor | None = None
        self._session: Any = None
        self.told = 0
        self.open(port)

    def open(self, port: int = 0) -> None:
        """Serve on this port, or on any free one if it is 0."""
        self._session = qi.Session()
        self._session.listenStandalone(f"tcp://127.0.0.1:{port}")
        self._own[ALAudioDevice] = self.microphones = ALAudioDevice(self.world, self._session)
        for kind in (*SERVICES, ALSonar, ALAudioDevice):
            if kind.__name__ not in self._without:
                made = self._own.get(kind) or (kind() if kind is ALSonar else kind(self.world))  # type: ignore[call-arg]
                self._session.registerService(kind.__name__, made)
        self.url = self._session.endpoints()[0]

    @property
    def port(self) -> int:
        return int(self.url.rpartition(":")[2])

    def drop(self) -> None:
        """Close the session at once, even during a call."""
        self._session.close()

    def close(self) -> None:
        self.times.close()
        self._session.close()

    def place(self, visitor: Visitor | None) -> None:
        self._visitor = visitor

    def face(self) -> tuple[float, float] | None:
        """Return the position of the visitor's face in the top camera's image [px], or None if there is no visitor."""
        if self._visitor is None:
            return None
        angles = self.world.joints.angles()
        place = (
            self._visitor.x,
            self._visitor.y,
            self._visitor.height * FACE_HEIGHT_FRACTION - PODIUM_HEIGHT - TORSO_HEIGHT,
        )
        return seen(place, self.world.body.camera, angles["HeadYaw"], angles["HeadPitch"])

    def touch(self, sensor: str, pressed: bool) -> None:
        if pressed != (sensor in self.world.pressed):
            self.world.pressed ^= {sensor}
            self.tell(event_of(sensor), 1.0 if pressed else 0.0)

    def tell(self, event: str, value: Any) -> None:
        """Raise an event of ALMemory."""
        self.told += self.memory.raised(event, value)
