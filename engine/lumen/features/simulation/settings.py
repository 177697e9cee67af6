"""The switches for the imperfections of a simulated robot: False makes the robot perfect in that respect."""

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class Imperfections:
    """The imperfections of a simulated robot."""

    noise: bool = True
    """True if sensors have noise."""
    quantisation: bool = True
    """True if encoders give whole steps."""
    gyro_bias: bool = True
    """True if the gyrometer measures a turn of a robot that does not turn."""
    latency: bool = True
    """True if a command acts one control period later."""
    backlash: bool = True
    """True if gears have play."""
    torque_speed: bool = True
    """True if the torque of a motor falls with its speed."""
    supply: bool = True
    """True if the torque of a motor falls with the battery's voltage."""


IMPERFECTIONS = tuple(field.name for field in fields(Imperfections))


def only(names: tuple[str, ...]) -> Imperfections:
    """Return a robot's imperfections with only these switched on."""
    return Imperfections(**{name: name in names for name in IMPERFECTIONS})


PERFECT = only(())
"""No imperfections: the robot as its model describes it."""
