"""Soft dark spots under feet: contact shadows, which a shadow map is too coarse to show."""

from collections.abc import Iterator, Mapping

import numpy as np

from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.visitor_figure import VISITOR_BODY

Soles = Mapping[str, tuple[float, float]]
"""The half length and half width of each sole [m], by the name of its site below the ankle."""
NO_SOLES: Soles = {}

SHADOW_FADES = 0.05
"""The height of a sole above the ground at which its spot becomes invisible [m]."""

LAYERS, LAYER_OPACITY = (0.75, 1.0, 1.3, 1.65), 0.13
BEYOND_SOLE, VISITOR_SIZE = (0.018, 0.015), (0.17, 0.2)
"""The extent of a spot beyond half a sole, ahead and sideways, and half the size of a visitor's spot [m]."""

_THICKNESS = 4e-4
_GROUND = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
"""The flags of the geom groups that count as ground: only group 0."""


class ContactShadows:
    """Adds the spots of the robot and of a visitor, if present, to a scene of one model."""

    def __init__(self, model: mujoco.MjModel, soles: Soles) -> None:
        self._model = model
        self._soles = [
            (model.site(name).id, (length + BEYOND_SOLE[0], width + BEYOND_SOLE[1]))
            for name, (length, width) in soles.items()
        ]
        visitor = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, VISITOR_BODY)
        self._visitor = visitor if visitor >= 0 else None

    def add(self, scene: mujoco.MjvScene, data: mujoco.MjData) -> None:
        """Add the spots to the scene, as many as fit."""
        for place, turn, (length, width), opacity in self._spots(data):
            for i, layer in enumerate(LAYERS):
                if scene.ngeom >= scene.maxgeom:
                    return
                size = np.array([length * layer, width * layer, _THICKNESS])
                spot = place + np.array([0.0, 0.0, (len(LAYERS) - i) * _THICKNESS / 2])
                colour = np.array([0.0, 0.0, 0.0, LAYER_OPACITY * opacity], dtype=np.float32)
                geom = scene.geoms[scene.ngeom]
                mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_ELLIPSOID, size, spot, turn.flatten(), colour)
                geom.category = mujoco.mjtCatBit.mjCAT_DECOR
                scene.ngeom += 1

    def _spots(self, data: mujoco.MjData) -> Iterator[tuple[np.ndarray, np.ndarray, tuple[float, float], float]]:
        for site, size in self._soles:
            axes, sole = data.site_xmat[site].reshape(3, 3), data.site_xpos[site]
            ahead = axes[:, 0]
            if spot := self._on_ground(data, sole + 0.045 * axes[:, 2] + 0.02 * ahead, float(sole[2])):
                place, height = spot
                if height < SHADOW_FADES:
                    yield place, _flat(ahead), size, 1.0 - max(height, 0.0) / SHADOW_FADES
        if self._visitor is not None and data.xpos[self._visitor][2] > -1.0:
            yield data.xpos[self._visitor].copy(), data.xmat[self._visitor].reshape(3, 3), VISITOR_SIZE, 1.0

    def _on_ground(self, data: mujoco.MjData, above: np.ndarray, sole: float) -> tuple[np.ndarray, float] | None:
        """Return the ground point below `above` and the height of `sole` over it [m]; None without ground."""
        hit = np.array([-1], dtype=np.int32)
        far = mujoco.mj_ray(self._model, data, above, np.array([0.0, 0.0, -1.0]), _GROUND, 1, -1, hit)
        if far < 0:
            return None
        place = above - np.array([0.0, 0.0, far])
        return place, sole - float(place[2])


def _flat(ahead: np.ndarray) -> np.ndarray:
    """Return the rotation matrix of a horizontal object whose front points in the direction `ahead`."""
    x, y = float(ahead[0]), float(ahead[1])
    length = max(float(np.hypot(x, y)), 1e-9)
    x, y = x / length, y / length
    return np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])
