"""What the robot feels of itself: encoders and gyrometer, in what they fall short."""

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
    """How fast its axes have turned [rad/s] on average, about themselves, in the control period that ends.

    A gyrometer filters, and so tells the mean. Who reads an instant of each period has a robot turn 3 % too slowly:
    motors that are told where to go once in a period jerk with it. `axes` (9,) change with the world; without any
    nothing ever turns.
    """

    def __init__(self, axes: NDArray[np.float64] | None) -> None:
        self._axes = axes
        self._before, self._now, self._turned = np.zeros(4), np.zeros(4), np.zeros(3)
        self._begun = False

    def feel(self) -> tuple[float, float, float]:
        """Roll to the right, pitch forward, turn to the left; nothing in the first period."""
        if self._axes is not None:
            self._before, self._now = self._now, self._before
            mujoco.mju_mat2Quat(self._now, self._axes)
            if self._begun:
                mujoco.mju_subQuat(self._turned, self._now, self._before)
            self._begun = True
        roll, pitch, yaw = (self._turned / CONTROL_PERIOD).tolist()
        return roll, pitch, yaw


LEARNING_PERIODS = 1200
"""How many control periods at rest count."""

REST, REST_SPREAD = 10, 0.05
"""At rest what it tells hardly changes: by so much at most [rad/s], in so many control periods."""


class GyroCalibration:
    """Learns the gyrometer's `bias` [rad/s], Shape (3,), whenever the robot is at rest; begins with one known before.

    A robot that breathes and shifts its weight turns to and fro: over twelve seconds that is nothing.
    """

    def __init__(self, bias: NDArray[np.float64]) -> None:
        self.bias = bias
        self._told = np.full((REST, 3), np.inf)
        self._next = 0

    def feel(self, rates: NDArray[np.float64], *, at_rest: bool) -> None:
        """Take note of what it tells in a control period [rad/s]; `at_rest`: nothing moves the robot on purpose."""
        self._told[self._next] = rates if at_rest else np.inf
        self._next = (self._next + 1) % REST
        if at_rest and max((np.maximum.reduce(self._told) - np.minimum.reduce(self._told)).tolist()) < REST_SPREAD:
            self.bias = self.bias + (rates - self.bias) / LEARNING_PERIODS


class Gyrometer:
    """Rates with noise and a bias that grows as the robot warms up, less the bias that it has learned at rest.

    The robot has rested before the run began: what it does not know of the bias then is a residue. Each robot's seed
    has its own bias.
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
        """How fast it believes to turn [rad/s], a control period later; `errors` are draws of a normal distribution."""
        self._periods += 1
        warmer = WARMING * (1.0 - exp(-self._periods * CONTROL_PERIOD / WARMING_TIME))
        told: NDArray[np.float64] = self._bias + warmer * self._drift + rates + self._noise * errors
        self._calibration.feel(told, at_rest=at_rest)
        believed: list[float] = (told - self._calibration.bias).tolist()
        return believed


_INERTIAL = [f"{kind}{axis}" for kind in ("Angle", "Gyroscope", "Accelerometer") for axis in "XYZ"]


class BodySensors:
    """Reads joint angles and turning speeds as the robot's own computer would; the same seed gives the same noise.

    `gyro` is how fast the torso rolls to the right and pitches forward [rad/s], `turning` how fast it turns left, less
    the bias that it has learned; `heading` is how far it has turned there since the start [rad]; all as felt last. The
    heading is right again to 3 degrees when the robot stands after it was down: the attitude follows the gyrometer, and
    where up is keeps it level.
    """

    def __init__(self, world: World, lacking: Imperfections, seed: int = 0) -> None:
        self._world, self._random = world, np.random.default_rng(seed)
        self._step = ENCODER_STEP if lacking.quantisation else 0.0
        self._noise = ENCODER_NOISE if lacking.noise else 0.0
        self._gyrometer, self._rates = Gyrometer(lacking, seed), MeanRates(world.gyro_axes)
        self.angles = world.angles
        """Where the encoders say the joints are."""
        self.gyro, self.turning = (0.0, 0.0), 0.0
        self.heading = 0.0
        self._attitude, self._axes, self._turns = np.array([1.0, 0.0, 0.0, 0.0]), np.eye(3).ravel(), np.zeros(3)

    @property
    def up(self) -> tuple[float, float, float]:
        """Where up is, in the torso's axes (forward, left, up), as the inertial unit tells."""
        return self._world.up

    @property
    def inertial(self) -> dict[str, float]:
        """The inertial unit as NAOqi names it: angles [rad], speeds [rad/s], accelerations [m/s^2] in the torso's axes.

        X is forward, Y left, Z up; AngleX is roll, AngleY pitch, AngleZ how far the robot has turned since the start.
        At rest the accelerometer feels the floor push upwards: Z is 9.81.
        """
        forward, left, up = self._world.up
        turning, pushed = (self.gyro[0], self.gyro[1], self.turning), self._world.acceleration
        angles = atan2(left, up), atan2(-forward, hypot(left, up)), self.heading
        return {name: round(v, 4) for name, v in zip(_INERTIAL, (*angles, *turning, *pushed), strict=True)}

    def feel(self, *, at_rest: bool) -> None:
        """Read encoders and gyrometer, once in each control period.

        `at_rest` is whether nothing moves the legs on purpose: then what turns is the gyrometer's bias.
        """
        angles, step = self._world.angles, self._step
        errors = self._random.standard_normal(len(angles) + 3)
        angles += self._noise * errors[3:]
        self.angles = np.rint(angles / step) * step if step else angles
        roll, pitch, yaw = self._gyrometer.feel(self._rates.feel(), errors[:3], at_rest=at_rest)
        self.gyro, self.turning = (roll, pitch), yaw
        self._turn(roll, pitch, yaw)

    def _turn(self, roll: float, pitch: float, yaw: float) -> None:
        """Turn the believed attitude as fast as the gyrometer says, and about level axes to where up is felt."""
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
