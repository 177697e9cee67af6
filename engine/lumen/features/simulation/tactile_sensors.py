"""The tactile sensors, pressed by the things in the hall that touch them."""

from collections.abc import Iterable

import numpy as np

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco

_SOLID = 2
"""The collision type of things in a hall other than the ground."""


class TactileSensors:
    """Checks the robot's contacts with things in the hall.

    A sensor is the box of the model's site of its name; those of `sensors` without a site are never pressed.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, sensors: Iterable[str], prefix: str = ROBOT_PREFIX
    ) -> None:
        self._model, self._data = model, data
        self._solid = set(np.flatnonzero(model.geom_contype == _SOLID).tolist())
        sites = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, f"{prefix}/{name}") for name in sensors}
        self._sites = {name: site for name, site in sites.items() if site >= 0}

    def pressed(self) -> set[str]:
        """Return the sensors that are pressed now."""
        touching = self._data.contact.geom
        if self._solid.isdisjoint(touching.ravel().tolist()):
            return set()
        at = [(i, pair) for i, pair in enumerate(touching.tolist()) if not self._solid.isdisjoint(pair)]
        return {name for i, pair in at for name, site in self._sites.items() if self._in(site, i, pair)}

    def _in(self, site: int, contact: int, pair: list[int]) -> bool:
        """Return whether a contact with the site's body is inside the site's box."""
        if self._model.site_bodyid[site] not in self._model.geom_bodyid[pair]:
            return False
        away = self._data.contact.pos[contact] - self._data.site_xpos[site]
        inside = np.abs(away @ self._data.site_xmat[site].reshape(3, 3)) <= self._model.site_size[site]
        return bool(inside.all())
