"""The force sensors under the feet: four in each, like NAO's `FSR`."""

from collections.abc import Iterable, Mapping
from itertools import compress

import numpy as np

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco
from lumen.language.roles import Roles

NEWTONS_PER_KILOGRAM = 9.81
"""Newtons per kilogram: ALMemory gives these forces in kilograms."""

SENSED_FEET = {"left": "LFoot", "right": "RFoot"}
"""ALMemory's names of the feet, by side."""


class ForceSensors:
    """Measures the force on each quarter of the soles at which the model has a touch sensor."""

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
        """Return the force at each sensor [kg] by ALMemory's name (`LFoot/FSR/FrontLeft`), and each foot's
        `TotalWeight`.
        """
        if not self._places:
            return {}
        felt = [newtons / NEWTONS_PER_KILOGRAM for newtons in self._data.sensordata.take(self._addresses).tolist()]
        weights = {name: round(weight, 3) for name, weight in zip(self._places, felt, strict=True)}
        for foot, own in self._feet.items():
            weights[f"{foot}/FSR/TotalWeight"] = round(sum(compress(felt, own)), 3)
        return weights


def _corners(model: mujoco.MjModel, names: Iterable[str], prefix: str) -> list[tuple[str, int]]:
    """Return each site's corner of the sole (`FrontLeft`) and its id."""
    sites = [model.site(f"{prefix}/{name}").id for name in names]
    middle = model.site_pos[sites].mean(axis=0)
    ahead = ["Front" if x > middle[0] else "Rear" for x in model.site_pos[sites, 0]]
    aside = ["Left" if y > middle[1] else "Right" for y in model.site_pos[sites, 1]]
    return [(f"{one}{other}", site) for one, other, site in zip(ahead, aside, sites, strict=True)]
