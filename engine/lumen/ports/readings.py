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
    """The senses that Lumen itself knows, as Lumen Server did in 2015; features add others."""

    IMAGE = "image"
    JOINT = "joint"
    SONAR = "sonar"
    TACTILE = "tactile"
    BATTERY = "battery"


class PixelSource(Protocol):
    """A function that renders or fetches a frame, of shape (height, width, 3), uint8 RGB.

    `size` is the size wanted now [px], None for the camera's own. A frame that was already taken in another size may be
    returned as it is; the next frames have the wanted size.
    """

    def __call__(self, size: Size | None = None) -> "NDArray[np.uint8]": ...


@dataclass(frozen=True, slots=True)
class Image:
    """A frame that is rendered only when `pixels` is called."""

    time: float
    pixels: PixelSource


class Whereabouts(NamedTuple):
    """A robot's estimate of its position, relative to its start: x forward, y left [m], theta to the left [rad].

    It is the sum of its steps: the real position may be up to `doubt` [m] away.
    """

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    doubt: float = 0.0


@dataclass(frozen=True, slots=True)
class Joints:
    """Measured joint angles and, if the robot measures them, further values."""

    time: float
    """When it was measured [s], on the robot's clock."""
    names: tuple[str, ...]
    angles: tuple[float, ...]
    """The angles in the order of `names` [rad, hands 0..1]."""
    stiffness: tuple[float, ...]
    """The stiffness in the order of `names` [0..1]."""
    temperature: tuple[float, ...] = ()
    """The temperature of each motor in the order of `names` [degrees Celsius]."""
    inertial: Mapping[str, float] = field(default_factory=dict)
    """The values of the inertial unit, with ALMemory's names and units."""
    fsr: Mapping[str, float] = field(default_factory=dict)
    """The weight on the soles, with ALMemory's names and units."""
    position: Whereabouts | None = None
    life: Mapping[str, float] = field(default_factory=dict)
    """The offsets of joints due to idle life, relative to their commands [rad, hands 0..1]."""


@dataclass(frozen=True, slots=True)
class Sonar:
    """Distance of the nearest echo on either side [m]."""

    time: float
    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Tactile:
    """The states of touch sensors in the order of `names`: 1 if a sensor is pressed, else 0."""

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
