"""Readings of the senses, from ALMemory, ALMotion and the camera."""

import logging
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lumen.errors import RobotError, RobotFailedError, SenseError
from lumen.features.naoqi.hardware import CHARGE, CHARGING, INERTIAL, PLUGGED, device, hardware_of
from lumen.features.naoqi.session import NaoqiSession
from lumen.language.robots import Body
from lumen.language.routes import BATTERY, IMAGE, JOINT, SIZES, SONAR, TACTILE, Size
from lumen.ports import Battery, Image, Joints, Reading, Sonar, Tactile, Whereabouts

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SUBSCRIBER_NAME = "lumen"
TOP_CAMERA, RGB_COLOUR_SPACE = 0, 11
RESOLUTIONS = {size: number for number, size in enumerate(SIZES)}
DEFAULT_IMAGE_SIZE = Size(320, 240)
CAMERA_RATE = 30
"""The camera's frame rate [1/s]; `NaoqiSensors.readers` has the rate at which frames are fetched."""
CLOCK_OFFSET_FRAMES = 100
"""The number of recent images whose shortest delay gives the offset between the robot's clock and Lumen's."""

_log = logging.getLogger(__name__)


class NaoqiSensors:
    """Reads a robot's senses; its methods wait for NAOqi, and raise RobotError if a sense can't be read.

    `heat` has the motors' temperatures by joint at the last reading [degrees Celsius]. `place` converts the result of
    `ALMotion.getRobotPosition` to the place on the stage; `life` returns the offsets of lifelike movements.
    """

    def __init__(
        self,
        session: NaoqiSession,
        body: Body,
        clock: Callable[[], float],
        place: Callable[[Sequence[float]], Whereabouts],
        life: Callable[[], Mapping[str, float]],
    ) -> None:
        self._session, self._body, self._clock, self._place, self._life = session, body, clock, place, life
        self.heat: dict[str, float] = {}
        self._numb = False
        self._names = list(body.joints)
        motors = [device(f"{body.shared.get(name, name)}/Temperature") for name in self._names]
        hardware = hardware_of(body)
        self._force, self._sonars = hardware.force, [device(name) for name in hardware.sonars]
        inertial = (device(f"{hardware.inertial}/{name}") for name in INERTIAL)
        self._felt = [*motors, *inertial, *map(device, self._force)]
        self._touches = {
            name: [device(d) for d in hardware.touch[name]] for name in body.tactile if name in hardware.touch
        }
        self._handle = ""
        self._own = Size(body.camera.width, body.camera.height) if body.camera else DEFAULT_IMAGE_SIZE
        self._size = self._wanted = self._own
        self._behind: deque[float] = deque(maxlen=CLOCK_OFFSET_FRAMES)

    def readers(self) -> Mapping[str, tuple[Callable[[], Reading], float]]:
        """Return each sense's reading function and its period [s], which matches the rate of the shipped routes."""
        return {
            IMAGE: (self.image, 0.066),
            JOINT: (self.joints, 0.05),
            SONAR: (self.sonar, 0.1),
            TACTILE: (self.tactile, 0.1),
            BATTERY: (self.battery, 1.0),
        }

    def begin(self) -> None:
        """Forget an earlier session's state, end its camera subscriptions, and subscribe to the sonars."""
        self._handle, self._numb = "", False
        self._behind.clear()
        if self._session.has("ALVideoDevice"):
            for handle in self._session.request("ALVideoDevice", "getSubscribers") or ():
                if str(handle).startswith(SUBSCRIBER_NAME):
                    self._session.post("ALVideoDevice", "unsubscribe", handle)
        if self._session.has("ALSonar"):
            self._session.post("ALSonar", "subscribe", SUBSCRIBER_NAME)

    def end(self) -> None:
        """End the subscriptions to the camera and the sonars."""
        self._let_go(0.5)
        if self._session.has("ALSonar"):
            self._session.post("ALSonar", "unsubscribe", SUBSCRIBER_NAME).wait(0.5)

    def joints(self) -> Joints:
        """Return the joints' angles and stiffness, with the robot's other internal senses."""
        now = self._clock()
        angles = self._numbers(self._session.request("ALMotion", "getAngles", self._names, True), "getAngles")
        stiffness = self._numbers(self._session.request("ALMotion", "getStiffnesses", self._names), "getStiffnesses")
        felt = *self._feelings(), self._whereabouts(), self._life()
        return Joints(now, tuple(self._names), angles, stiffness, *felt)

    def sonar(self) -> Sonar:
        """Return the distances to obstacles on the left and right [m].

        Raises SenseError if the robot has no sonars or no sonar values.
        """
        if not self._session.has("ALSonar"):
            raise SenseError("this robot has no ALSonar")
        now = self._clock()
        left, right = self._memory(self._sonars)
        if not isinstance(left, int | float) or not isinstance(right, int | float):
            raise SenseError("ALMemory has no sonar values")
        return Sonar(now, float(left), float(right))

    def tactile(self) -> Tactile:
        """Return each tactile sensor's state: 1 if it is pressed, else 0."""
        now = self._clock()
        found = iter(self._memory([key for keys in self._touches.values() for key in keys]))
        pressed = {name: sum(bool(next(found)) for _ in keys) > 0 for name, keys in self._touches.items()}
        return Tactile(now, self._body.tactile, tuple(int(pressed.get(name, False)) for name in self._body.tactile))

    def battery(self) -> Battery:
        """Return the battery's charge [%], and whether it is plugged in and charging.

        Raises SenseError if the robot reports no charge.
        """
        now = self._clock()
        charge, plugged, charging = self._memory([CHARGE, PLUGGED, CHARGING])
        if not isinstance(charge, int | float):
            raise SenseError("ALMemory has no battery level")
        percentage = round(100 * min(max(float(charge), 0.0), 1.0))
        return Battery(now, percentage, plugged=bool(plugged) or bool(charging), charging=bool(charging))

    def image(self) -> Image:
        """Return the top camera's newest image, with its time on Lumen's clock [s]."""
        if self._wanted != self._size:
            self._let_go()
            self._size = self._wanted
        handle = self._handle or self._subscribe()
        try:
            found = self._session.request("ALVideoDevice", "getImageRemote", handle)
            pixels, stamp = self._pixels(found)
        except RobotError:
            self._handle = ""
            raise
        self._session.post("ALVideoDevice", "releaseImage", handle)
        self._behind.append(self._clock() - stamp)
        width, height = self._size

        def shaped(size: Size | None = None) -> "NDArray[np.uint8]":
            import numpy as np

            self._wanted = size or self._own
            return np.frombuffer(pixels, np.uint8).reshape(height, width, 3)

        return Image(stamp + min(self._behind), shaped)

    def _feelings(self) -> tuple[tuple[float, ...], dict[str, float], dict[str, float]]:
        """Return the motors' temperatures [degrees Celsius], the inertial unit's values and the forces under the soles.

        Missing values are left out; temperatures are empty unless all are available. Everything is empty, and a warning
        is logged once, if ALMemory can't be read. Raises RobotLostError if the connection breaks.
        """
        try:
            found, motors = self._memory(self._felt), len(self._names)
        except (RobotFailedError, SenseError) as error:
            if not self._numb:
                self._numb = True
                _log.warning(
                    "the robot does not report its temperatures, its balance and the weight on its feet: %s", error
                )
            return (), {}, {}
        inertial, soles = found[motors : motors + len(INERTIAL)], found[motors + len(INERTIAL) :]
        self.heat = _known(n for n in zip(self._names, found, strict=False) if n[0] not in self._body.shared)
        temperature = tuple(float(t) for t in found[:motors] if isinstance(t, int | float))
        whole = temperature if len(temperature) == motors else ()
        return whole, _known(zip(INERTIAL, inertial, strict=True)), _known(zip(self._force, soles, strict=True))

    def _whereabouts(self) -> Whereabouts | None:
        """Return the robot's place on the stage by odometry; None if odometry is unavailable."""
        try:
            found = self._session.request("ALMotion", "getRobotPosition", True)
            return self._place([float(found[i]) for i in range(3)])
        except (RobotError, TypeError, ValueError, IndexError):
            return None

    def _let_go(self, patience: float = 0.0) -> None:
        """Unsubscribe from the camera, and wait at most `patience` [s] for the answer."""
        if self._handle:
            self._session.post("ALVideoDevice", "unsubscribe", self._handle).wait(patience)
        self._handle = ""

    def _subscribe(self) -> str:
        if self._size not in RESOLUTIONS:
            raise SenseError(f"the robot's camera has no images of {self._size}")
        arguments = (SUBSCRIBER_NAME, TOP_CAMERA, RESOLUTIONS[self._size], RGB_COLOUR_SPACE, CAMERA_RATE)
        self._handle = str(self._session.request("ALVideoDevice", "subscribeCamera", *arguments) or "")
        if not self._handle:
            raise SenseError("cannot subscribe to the camera: too many programs use it")
        return self._handle

    def _pixels(self, found: Any) -> tuple[bytes, float]:
        """Return a frame's bytes, and its time on the robot's clock [s]. Raises SenseError if it is invalid."""
        if not isinstance(found, Sequence) or len(found) < 7:
            raise SenseError("the camera gave no image: another program has unsubscribed it, or there is no camera")
        width, height, layers, _, seconds, microseconds, pixels = found[:7]
        if (width, height, layers) != (*self._size, 3):
            raise SenseError(f"the camera gave an image of {width} x {height} x {layers}, not of {self._size} x 3")
        if not isinstance(pixels, bytes | bytearray) or len(pixels) != width * height * layers:
            raise SenseError(f"the camera gave {len(pixels) if pixels else 0} bytes for {width} x {height} x {layers}")
        return bytes(pixels), float(seconds) + float(microseconds) / 1e6

    def _memory(self, keys: list[str]) -> list[Any]:
        found = self._session.request("ALMemory", "getListData", keys)
        if not isinstance(found, Sequence) or len(found) != len(keys):
            raise SenseError("ALMemory did not answer for every key")
        return list(found)

    def _numbers(self, found: Any, method: str) -> tuple[float, ...]:
        if not isinstance(found, Sequence) or len(found) != len(self._names):
            raise SenseError(f"ALMotion.{method} did not answer for every joint")
        return tuple(map(float, found))


def _known(found: Iterable[tuple[str, Any]]) -> dict[str, float]:
    """Return the numeric values by name, rounded to four decimals."""
    return {name: round(float(value), 4) for name, value in found if isinstance(value, int | float)}
