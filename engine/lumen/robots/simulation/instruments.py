"""What the robot feels of itself: encoders and gyrometer, with their noise."""

import numpy as np

from lumen.robots.simulation.limits import Angles
from lumen.robots.simulation.world import PERIOD, World

ENCODER, GYRO = 0.0017, 0.03
"""Standard deviations of an encoder [rad], whose step is 0.1 degrees, and of the gyrometer [rad/s]; at noise 1."""


class Instruments:
    """Reads joint angles and turning speeds as the robot's own computer would; the same seed gives the same noise.

    `gyro` is how fast the torso rolls to the right and pitches forward [rad/s], `heading` how far it has turned to the
    left since the start [rad], both as felt last.
    """

    def __init__(self, world: World, noise: float = 0.0, seed: int = 0) -> None:
        self._world, self._level = world, noise
        self._random = np.random.default_rng(seed)
        self.gyro = 0.0, 0.0
        self.heading = 0.0

    @property
    def up(self) -> tuple[float, float, float]:
        """Where up is, in the torso's axes (forward, left, up), as the inertial unit tells."""
        return self._world.up

    @property
    def angles(self) -> Angles:
        """Where the encoders say the joints are."""
        measured = self._world.angles
        return measured + self._random.normal(0, self._level * ENCODER, measured.shape) if self._level else measured

    def feel(self) -> None:
        """Read the gyrometer, once in each control period."""
        roll, pitch, yaw = self._world.gyro
        if self._level:
            errors = self._random.normal(0, self._level * GYRO, 3).tolist()
            roll, pitch, yaw = roll + errors[0], pitch + errors[1], yaw + errors[2]
        self.gyro = roll, pitch
        self.heading += yaw * PERIOD
