"""How much the simulated robot's sensors and motors fall short: docs/imperfections.md has the sources."""

from math import radians

ENCODER_STEP = radians(0.1)
"""Of magnetic encoders of 12 bits [rad] (Aldebaran's documentation 2-1)."""

ENCODER_NOISE = 0.0017
"""Standard deviation [rad], chosen: about one step."""

GYRO_NOISE = radians(0.21)
"""Standard deviation [rad/s]: 0.03 deg/s for each square root of Hz (ST's L3G4200D), over 50 Hz."""

GYRO_BIAS = radians(15.0)
"""The most that a gyrometer tells while nothing turns [rad/s]: the zero-rate level of ST's L3G4200D at 500 deg/s."""

GYRO_DRIFT, WARMING, WARMING_TIME = radians(0.04), 20.0, 1200.0
"""How much that changes with the temperature [rad/s per degree] (L3G4200D), at most; how many degrees the torso gets
warmer, and the time constant of that [s]: chosen."""

GYRO_RESIDUE = 3e-4
"""What the robot does not know of its gyrometer's bias as a run begins [rad/s], standard deviation: chosen."""

LATENCY = 1
"""Control periods until a command acts: the cycle of NAOqi's DCM and of LoLA, 10 to 12 ms."""

BACKLASH = 0.01
"""How far a joint turns while its motor stands still [rad]: what Webots has for a robot of that size, ROBOTIS OP2."""

NOMINAL_VOLTAGE, FULL_VOLTAGE, EMPTY_VOLTAGE = 21.6, 25.2, 18.0
"""Of NAO's battery [V]: six lithium cells in a row (data sheet: 21.6 V), each 4.2 V when full and 3.0 V when empty."""


def voltage(charge: float) -> float:
    """What the battery gives [V] with that charge (0..1)."""
    return EMPTY_VOLTAGE + (FULL_VOLTAGE - EMPTY_VOLTAGE) * charge
