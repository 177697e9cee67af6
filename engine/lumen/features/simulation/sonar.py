"""Two ultrasonic sensors, as rays in a cone."""

from collections.abc import Mapping
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco
from lumen.language.robots import Ultrasound
from lumen.language.roles import SIDES

_ECHOING = np.array([0, 1, 0, 0, 0, 0], dtype=np.uint8)
"""Geom group 1, the things in the hall. The ground reflects sound away, and the robot does not detect itself."""

_RINGS = ((0.0, 1), (0.45, 6), (0.9, 8))
SONAR_RESOLUTION, SONAR_NOISE = 0.01, 0.003


class Sonars:
    """Measures the nearest echo on either side [m], with a little noise."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        sensor: Ultrasound,
        sites: Mapping[str, str],
        seed: int,
        prefix: str = ROBOT_PREFIX,
    ) -> None:
        self._model, self._data, self._sensor = model, data, sensor
        self._sites = [f"{prefix}/{sites[side]}" for side in SIDES if side in sites]
        self._rays = _cone(sensor.cone / 2)
        self._noise = np.random.default_rng(seed)
        self._distances = np.zeros(len(self._rays))
        self._hit = np.zeros(len(self._rays), dtype=np.int32)

    def measure(self) -> tuple[float, float]:
        """Return the distances left and right [m], at most the sensor's range; a single sensor gives both."""
        heard = [self._heard(name) for name in self._sites]
        return heard[0], heard[-1]

    def _heard(self, name: str) -> float:
        site = self._data.site(name)
        rays = (self._rays @ site.xmat.reshape(3, 3).T).ravel()
        farthest, found = self._sensor.maximum, self._distances
        mujoco.mj_multiRay(
            self._model, self._data, site.xpos, rays, _ECHOING, 1, -1, self._hit, found, None, found.size, farthest
        )
        nearest = float(np.min(found, initial=farthest, where=found >= 0))
        heard = round((nearest + self._noise.normal(0, SONAR_NOISE)) / SONAR_RESOLUTION) * SONAR_RESOLUTION
        return round(min(max(heard, self._sensor.minimum), self._sensor.maximum), 3)


def _cone(half: float) -> NDArray[np.float64]:
    """Return directions around x in a cone of that half angle [rad]: Shape (rays, 3)."""
    rays = []
    for part, count in _RINGS:
        angle = part * half
        for k in range(count):
            around = 2 * pi * k / count
            rays.append((cos(angle), sin(angle) * cos(around), sin(angle) * sin(around)))
    return np.array(rays)
