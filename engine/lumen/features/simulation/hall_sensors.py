"""The sensors for the robot's surroundings: touch, forces under the feet (NAO's `FSR`), and ultrasonic echoes."""

from collections.abc import Iterable, Mapping
from itertools import compress
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco
from lumen.language.robots import Ultrasound
from lumen.language.roles import SIDES, Roles

_SOLID = 2
"""The collision type of objects in a hall other than the ground."""


class TactileSensors:
    """Checks the contacts between the robot's sensors and objects in the hall.

    Each sensor is the box of the site with the sensor's name in the model; sensors without a site are never pressed.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, sensors: Iterable[str], prefix: str = ROBOT_PREFIX
    ) -> None:
        self._model, self._data = model, data
        self._solid = set(np.flatnonzero(model.geom_contype == _SOLID).tolist())
        sites = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, f"{prefix}/{name}") for name in sensors}
        self._sites = {name: site for name, site in sites.items() if site >= 0}

    def pressed(self) -> set[str]:
        """Return the names of the sensors that objects in the hall are pressing."""
        touching = self._data.contact.geom
        if self._solid.isdisjoint(touching.ravel().tolist()):
            return set()
        at = [(i, pair) for i, pair in enumerate(touching.tolist()) if not self._solid.isdisjoint(pair)]
        return {name for i, pair in at for name, site in self._sites.items() if self._in(site, i, pair)}

    def _in(self, site: int, contact: int, pair: list[int]) -> bool:
        """Return True if a contact involves the site's body and is inside the site's box."""
        if self._model.site_bodyid[site] not in self._model.geom_bodyid[pair]:
            return False
        away = self._data.contact.pos[contact] - self._data.site_xpos[site]
        inside = np.abs(away @ self._data.site_xmat[site].reshape(3, 3)) <= self._model.site_size[site]
        return bool(inside.all())


NEWTONS_PER_KILOGRAM = 9.81
"""The newtons in a kilogram-force: ALMemory stores these forces in kilograms."""

SENSED_FEET = {"left": "LFoot", "right": "RFoot"}
"""ALMemory's names of the feet, by side."""


class ForceSensors:
    """Measures the force on each quarter of a sole for which the model has a touch sensor."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, roles: Roles, prefix: str = ROBOT_PREFIX) -> None:
        touch = np.flatnonzero(model.sensor_type == mujoco.mjtSensor.mjSENS_TOUCH)
        places = {int(model.sensor_objid[sensor]): int(model.sensor_adr[sensor]) for sensor in touch}
        self._places = {
            f"{SENSED_FEET[side]}/FSR/{corner}": places[site]
            for side, names in roles.sensors.force.items()
            for corner, site in _corners(model, names, prefix)
            if site in places
        }
        self._data, self._addresses = data, np.array(list(self._places.values()), np.intp)
        self._feet = {foot: [name.startswith(foot) for name in self._places] for foot in SENSED_FEET.values()}

    def weigh(self) -> Mapping[str, float]:
        """Return each sensor's force and each foot's total [kg], by ALMemory's names; empty without sensors.

        Examples of names are `LFoot/FSR/FrontLeft` and `LFoot/FSR/TotalWeight`.
        """
        if not self._places:
            return {}
        felt = [newtons / NEWTONS_PER_KILOGRAM for newtons in self._data.sensordata.take(self._addresses).tolist()]
        weights = {name: round(weight, 3) for name, weight in zip(self._places, felt, strict=True)}
        for foot, own in self._feet.items():
            weights[f"{foot}/FSR/TotalWeight"] = round(sum(compress(felt, own)), 3)
        return weights


def _corners(model: mujoco.MjModel, names: Iterable[str], prefix: str) -> list[tuple[str, int]]:
    """Return each site's corner of the sole, such as `FrontLeft`, and its id."""
    sites = [model.site(f"{prefix}/{name}").id for name in names]
    middle = model.site_pos[sites].mean(axis=0)
    ahead = ["Front" if x > middle[0] else "Rear" for x in model.site_pos[sites, 0]]
    aside = ["Left" if y > middle[1] else "Right" for y in model.site_pos[sites, 1]]
    return [(f"{one}{other}", site) for one, other, site in zip(ahead, aside, sites, strict=True)]


_ECHOING = np.array([0, 1, 0, 0, 0, 0], dtype=np.uint8)
"""Only geom group 1, the objects in the hall. The ground reflects sound away, and the robot does not detect itself."""

_RINGS = ((0.0, 1), (0.45, 6), (0.9, 8))
SONAR_RESOLUTION, SONAR_NOISE = 0.01, 0.003


class Sonars:
    """Measures the distance of the nearest echo on either side [m], with noise."""

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
        """Return the distances left and right [m], limited to the sensor's range; a single sensor gives both."""
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
    """Return unit vectors in a cone around x with this half angle [rad]: Shape (rays, 3)."""
    rays = []
    for part, count in _RINGS:
        angle = part * half
        for k in range(count):
            around = 2 * pi * k / count
            rays.append((cos(angle), sin(angle) * cos(around), sin(angle) * sin(around)))
    return np.array(rays)
