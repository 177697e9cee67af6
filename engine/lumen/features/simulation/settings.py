"""In what a simulated robot falls short of its model: each is a switch, how much of it stands in the simulation."""

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class Imperfections:
    """What is False the robot does perfectly.

    Sensors have `noise`, encoders tell whole steps (`quantisation`), the gyrometer turns while nothing does
    (`gyro_bias`). A command acts a control period later (`latency`), gears have play (`backlash`), the torque of a
    motor falls with its speed (`torque_speed`), and with the battery's voltage (`supply`).
    """

    noise: bool = True
    quantisation: bool = True
    gyro_bias: bool = True
    latency: bool = True
    backlash: bool = True
    torque_speed: bool = True
    supply: bool = True


IMPERFECTIONS = tuple(field.name for field in fields(Imperfections))


def only(names: tuple[str, ...]) -> Imperfections:
    """A robot with these imperfections and no others."""
    return Imperfections(**{name: name in names for name in IMPERFECTIONS})


PERFECT = only(())
"""A robot as its model has it."""
