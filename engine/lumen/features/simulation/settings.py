"""The switches for the imperfections of a simulated robot: False makes the robot perfect in that respect."""

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class Imperfections:
    """The imperfections of a simulated robot."""

    noise: bool = True
    """Sensors have noise."""
    quantisation: bool = True
    """Encoders give whole steps."""
    gyro_bias: bool = True
    """The gyrometer measures a turn of a robot that does not turn."""
    latency: bool = True
    """A command acts one control period later."""
    backlash: bool = True
    """Gears have play."""
    torque_speed: bool = True
    """The torque of a motor falls with its speed."""
    supply: bool = True
    """The torque of a motor falls with the battery's voltage."""


IMPERFECTIONS = tuple(field.name for field in fields(Imperfections))


def only(names: tuple[str, ...]) -> Imperfections:
    """Return a robot's imperfections with only these switched on."""
    return Imperfections(**{name: name in names for name in IMPERFECTIONS})


PERFECT = only(())
"""No imperfections: the robot as its model describes it."""
