"""The robot's encoders, gyrometer and inertial unit, with their errors."""

from math import atan2, exp, hypot

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.imperfections import (
    ENCODER_NOISE,
    ENCODER_STEP,
    GYRO_BIAS,
    GYRO_DRIFT,
    GYRO_NOISE,
    GYRO_RESIDUE,
    WARMING,
    WARMING_TIME,
)
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import CONTROL_PERIOD, World
from lumen.motion.gait.poses import wrap


class MeanRates:
    """The average rates [rad/s] of a sensor's rotation about its own axes in the last control period.

    A real gyrometer filters, and so reports averages. With instantaneous rates, the robot would turn 3 % too slowly,
    because motors jerk once in each period. `axes`, Shape (9,), change with the world; with None, the rates are 0.
    """

    def __init__(self, axes: NDArray[np.float64] | None) -> None:
        self._axes = axes
        self._before, self._now, self._turned = np.zeros(4), np.zeros(4), np.zeros(3)
        self._begun = False

    def feel(self) -> tuple[float, float, float]:
        """Return the rates of rolling right, pitching forward and turning left [rad/s]; 0 in the first period."""
        if self._axes is not None:
            self._before, self._now = self._now, self._before
            mujoco.mju_mat2Quat(self._now, self._axes)
            if self._begun:
                mujoco.mju_subQuat(self._turned, self._now, self._before)
            self._begun = True
        roll, pitch, yaw = (self._turned / CONTROL_PERIOD).tolist()
        return roll, pitch, yaw


LEARNING_PERIODS = 1200
"""The time constant of the learned bias, in control periods at rest."""

REST, REST_SPREAD = 10, 0.05
"""The number of control periods, and the spread of their readings [rad/s] below which the robot counts as at rest."""


class GyroCalibration:
    """Learns the gyrometer's `bias` [rad/s], Shape (3,), from a known start value, whenever the robot is at rest.

    Averaging over twelve seconds cancels the rotations of breathing and weight shifts.
    """

    def __init__(self, bias: NDArray[np.float64]) -> None:
        self.bias = bias
        self._told = np.full((REST, 3), np.inf)
        self._next = 0

    def feel(self, rates: NDArray[np.float64], *, at_rest: bool) -> None:
        """Update the bias with one period's rates [rad/s]; `at_rest` means that nothing moves the robot on purpose."""
        self._told[self._next] = rates if at_rest else np.inf
        self._next = (self._next + 1) % REST
        if at_rest and max((np.maximum.reduce(self._told) - np.minimum.reduce(self._told)).tolist()) < REST_SPREAD:
            self.bias = self.bias + (rates - self.bias) / LEARNING_PERIODS


class Gyrometer:
    """A gyrometer with noise and a bias that drifts as the robot warms up; the bias learned at rest is subtracted.

    The robot is assumed to have rested before the run, so the learned bias begins with only a small error. Each seed
    gives a different bias.
    """

    def __init__(self, lacking: Imperfections, seed: int) -> None:
        draw = np.random.default_rng((seed, 1))
        whole = float(lacking.gyro_bias)
        self._bias = whole * draw.uniform(-GYRO_BIAS, GYRO_BIAS, 3)
        self._drift = whole * draw.uniform(-GYRO_DRIFT, GYRO_DRIFT, 3)
        self._noise = GYRO_NOISE if lacking.noise else 0.0
        self._calibration = GyroCalibration(self._bias + whole * draw.normal(0.0, GYRO_RESIDUE, 3))
        self._periods = 0

    def feel(self, rates: tuple[float, float, float], errors: NDArray[np.float64], *, at_rest: bool) -> list[float]:
        """Return the measured rates of the next control period [rad/s].

        `rates` are the true rates, and `errors` are draws from the standard normal distribution. `at_rest` means that
        nothing moves the robot on purpose.
        """
        self._periods += 1
        warmer = WARMING * (1.0 - exp(-self._periods * CONTROL_PERIOD / WARMING_TIME))
        told: NDArray[np.float64] = self._bias + warmer * self._drift + rates + self._noise * errors
        self._calibration.feel(told, at_rest=at_rest)
        believed: list[float] = (told - self._calibration.bias).tolist()
        return believed


_INERTIAL = [f"{kind}{axis}" for kind in ("Angle", "Gyroscope", "Accelerometer") for axis in "XYZ"]


class BodySensors:
    """Reads joint angles and rates as the robot's own computer would; the same seed gives the same noise.

    `gyro` has the last measured rates of rolling right and pitching forward [rad/s], and `turning` is the rate of
    turning left, all without the learned bias. `heading` is the angle turned left since the start [rad]. After lying or
    sitting, its error is at most 3 degrees, because gravity keeps the estimated attitude level.
    """

    def __init__(self, world: World, lacking: Imperfections, seed: int = 0) -> None:
        self._world, self._random = world, np.random.default_rng(seed)
        self._step = ENCODER_STEP if lacking.quantisation else 0.0
        self._noise = ENCODER_NOISE if lacking.noise else 0.0
        self._gyrometer, self._rates = Gyrometer(lacking, seed), MeanRates(world.gyro_axes)
        self.angles = world.angles
        """The angles measured by the encoders [rad; hands 0..1]."""
        self.gyro, self.turning = (0.0, 0.0), 0.0
        self.heading = 0.0
        self._attitude, self._axes, self._turns = np.array([1.0, 0.0, 0.0, 0.0]), np.eye(3).ravel(), np.zeros(3)

    @property
    def up(self) -> tuple[float, float, float]:
        """The unit vector that points up, in the torso's axes (forward, left, up), measured by the inertial unit."""
        return self._world.up

    @property
    def inertial(self) -> dict[str, float]:
        """The inertial unit's angles [rad], rates [rad/s] and accelerations [m/s^2] by NAOqi's names.

        In the torso's axes, X is forward, Y left, Z up. AngleX is roll, AngleY pitch, AngleZ the angle turned left
        since the start. At rest, the accelerometer measures the floor's upward force: Z is 9.81.
        """
        forward, left, up = self._world.up
        turning, pushed = (self.gyro[0], self.gyro[1], self.turning), self._world.acceleration
        angles = atan2(left, up), atan2(-forward, hypot(left, up)), self.heading
        return {name: round(v, 4) for name, v in zip(_INERTIAL, (*angles, *turning, *pushed), strict=True)}

    def feel(self, *, at_rest: bool) -> None:
        """Read the encoders and the gyrometer; call this once in each control period.

        `at_rest` means that nothing moves the legs on purpose, so the gyrometer's average reading is its bias.
        """
        angles, step = self._world.angles, self._step
        errors = self._random.standard_normal(len(angles) + 3)
        angles += self._noise * errors[3:]
        self.angles = np.rint(angles / step) * step if step else angles
        roll, pitch, yaw = self._gyrometer.feel(self._rates.feel(), errors[:3], at_rest=at_rest)
        self.gyro, self.turning = (roll, pitch), yaw
        self._turn(roll, pitch, yaw)

    def _turn(self, roll: float, pitch: float, yaw: float) -> None:
        """Turn the estimated attitude by the gyrometer's rates, level it by gravity, and update the heading."""
        axes, (x, y, z) = self._axes, self._world.up
        _, _, _, _, _, _, u, v, w = axes.tolist()
        self._turns[:] = (
            roll + (y * w - z * v) / CONTROL_PERIOD,
            pitch + (z * u - x * w) / CONTROL_PERIOD,
            yaw + (x * v - y * u) / CONTROL_PERIOD,
        )
        mujoco.mju_quatIntegrate(self._attitude, self._turns, CONTROL_PERIOD)
        mujoco.mju_quat2Mat(axes, self._attitude)
        self.heading += wrap(atan2(axes[3], axes[0]) - self.heading)
