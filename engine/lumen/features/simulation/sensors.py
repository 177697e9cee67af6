"""What the robot feels of itself: encoders and gyrometer, in what they fall short."""

from math import atan2, hypot

import numpy as np

from lumen.features.simulation.gyrometer import Gyrometer
from lumen.features.simulation.imperfections import ENCODER_NOISE, ENCODER_STEP
from lumen.features.simulation.mean_rates import MeanRates
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import CONTROL_PERIOD, World
from lumen.motion.gait.poses import wrap

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
