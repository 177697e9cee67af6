"""The senses of a robot, and their readings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

from lumen.language.routes import Size


class Sense(StrEnum):
    """The five kinds of data that Lumen Server acquires in parallel."""

    IMAGE = "image"
    JOINT = "joint"
    SONAR = "sonar"
    TACTILE = "tactile"
    BATTERY = "battery"


class PixelSource(Protocol):
    """Renders or fetches a frame: Shape (height, width, 3), uint8 RGB.

    `size` [px] is the size wanted now, None for the camera's own. If a frame was already taken in another size, the
    robot may return it as it is, and the next frames in the wanted size.
    """

    def __call__(self, size: Size | None = None) -> "NDArray[np.uint8]": ...


@dataclass(frozen=True, slots=True)
class Image:
    """A frame that is made only when `pixels` is called."""

    time: float
    pixels: PixelSource


class Whereabouts(NamedTuple):
    """A robot's estimate of its position, relative to its start: x forward, y left [m], theta to the left [rad].

    It only adds up its steps: the real position may be `doubt` [m] away.
    """

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    doubt: float = 0.0


@dataclass(frozen=True, slots=True)
class Joints:
    """Measured angles [rad, hands 0..1] and stiffness [0..1], in the order of `names`.

    If the robot measures them, also: each motor's `temperature` [degrees Celsius] in that order, the inertial unit and
    the weight on its soles, with ALMemory's names and units, and the estimate of its position. `life` is how far it has
    moved joints of its own accord, beside where commands want them.
    """

    time: float
    names: tuple[str, ...]
    angles: tuple[float, ...]
    stiffness: tuple[float, ...]
    temperature: tuple[float, ...] = ()
    inertial: Mapping[str, float] = field(default_factory=dict)
    fsr: Mapping[str, float] = field(default_factory=dict)
    position: Whereabouts | None = None
    life: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Sonar:
    """Distance of the nearest echo on either side [m]."""

    time: float
    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Tactile:
    """1 where a sensor is pressed, else 0, in the order of `names`."""

    time: float
    names: tuple[str, ...]
    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Battery:
    """Charge [%], and whether the battery is plugged in and charging."""

    time: float
    percentage: int
    plugged: bool
    charging: bool


NumericReading = Joints | Sonar | Tactile | Battery
Reading = Image | NumericReading
