"""The sizes of the simulated sensors' and motors' errors; docs/imperfections.md has the sources."""

from math import radians

ENCODER_STEP = radians(0.1)
"""The resolution of 12-bit magnetic encoders [rad] (Aldebaran's documentation 2-1)."""

ENCODER_NOISE = 0.0017
"""The standard deviation of the encoders' noise [rad], chosen: about one step."""

GYRO_NOISE = radians(0.21)
"""The standard deviation of the gyrometer's noise [rad/s].

It is 0.03 deg/s per square root of Hz (ST's L3G4200D), over 50 Hz.
"""

GYRO_BIAS = radians(15.0)
"""The maximum bias of a gyrometer [rad/s]: the zero-rate level of ST's L3G4200D at 500 deg/s."""

GYRO_DRIFT, WARMING, WARMING_TIME = radians(0.04), 20.0, 1200.0
"""The bias's maximum drift [rad/s per degree], the torso's final warming [degrees], and its time constant [s].

The first number is from the data sheet of ST's L3G4200D; the others are chosen.
"""

GYRO_RESIDUE = 3e-4
"""The standard deviation of the initial error of the learned bias [rad/s], chosen."""

LATENCY = 1
"""The delay until a command acts, in control periods: the cycle of NAOqi's DCM and of LoLA, 10 to 12 ms."""

BACKLASH = 0.01
"""The angle by which a joint can turn while its motor does not move [rad].

It is Webots' value for ROBOTIS OP2, a robot of NAO's size.
"""

NOMINAL_VOLTAGE, FULL_VOLTAGE, EMPTY_VOLTAGE = 21.6, 25.2, 18.0
"""The voltages of NAO's battery [V]: nominal, full and empty.

The battery has six lithium cells in series (data sheet: 21.6 V), each 4.2 V full and 3.0 V empty.
"""


def voltage(charge: float) -> float:
    """Return the battery's voltage [V] at a charge from 0 to 1."""
    return EMPTY_VOLTAGE + (FULL_VOLTAGE - EMPTY_VOLTAGE) * charge
