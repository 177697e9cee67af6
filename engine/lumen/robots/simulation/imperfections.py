"""In what the simulated robot's sensors and motors fall short: on by default, each to be switched off."""

from dataclasses import dataclass
from math import radians

NOMINAL_VOLTAGE, FULL_VOLTAGE, EMPTY_VOLTAGE = 21.6, 25.2, 18.0
"""Of NAO's battery [V]: six lithium cells in a row (data sheet: 21.6 V), each 4.2 V when full and 3.0 V when empty."""


@dataclass(frozen=True, slots=True)
class Imperfections:
    """What is given is chosen where no source is named; 0 or False switches one off.

    `encoder_step` [rad]: magnetic encoders of 12 bits, 0.1 degrees (Aldebaran's documentation 2-1). `encoder_noise` and
    `gyro_noise` are standard deviations [rad], [rad/s]. `latency` [control periods]: a command of one period acts in a
    later one, as in the cycle of NAOqi's DCM. `torque_falls`: a motor that turns has less torque, along the line from
    its stall torque (`user` of the actuators in the MJCF) to its no-load speed (`getLimits`), both as the battery's
    voltage has them; the published limit caps it.
    """

    encoder_step: float = radians(0.1)
    encoder_noise: float = 0.0017
    gyro_noise: float = 0.03
    latency: int = 1
    torque_falls: bool = True


PERFECT = Imperfections(0.0, 0.0, 0.0, 0, False)
"""A robot as its model has it."""


def voltage(charge: float) -> float:
    """What the battery gives [V] with that charge (0..1)."""
    return EMPTY_VOLTAGE + (FULL_VOLTAGE - EMPTY_VOLTAGE) * charge
