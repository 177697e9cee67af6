"""The switches for a simulated robot's imperfections; False removes an imperfection."""

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class Imperfections:
    """A simulated robot's imperfections."""

    noise: bool = True
    """True if sensors have noise."""
    quantisation: bool = True
    """True if encoders report whole steps."""
    gyro_bias: bool = True
    """True if the gyrometer measures a rotation while the robot is still."""
    latency: bool = True
    """True if a command acts one control period later."""
    backlash: bool = True
    """True if gears have play."""
    torque_speed: bool = True
    """True if a motor's torque decreases with its speed."""
    supply: bool = True
    """True if a motor's torque decreases with the battery's voltage."""


IMPERFECTIONS = tuple(field.name for field in fields(Imperfections))


def only(names: tuple[str, ...]) -> Imperfections:
    """Return imperfections with only these switched on."""
    return Imperfections(**{name: name in names for name in IMPERFECTIONS})


PERFECT = only(())
"""No imperfections: the robot exactly as modelled."""
