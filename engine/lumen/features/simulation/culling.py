"""What a camera has no chance to see, and need not be sent to OpenGL."""

from math import hypot, radians, tan

import numpy as np

from lumen.features.simulation.physics import mujoco

HIDDEN = mujoco.mjNGROUP - 1
"""A group of geoms that is not drawn."""


class FrustumCulling:
    """Hides geoms of one model that end outside of the cone around a camera's picture; planes have no end.

    It sets their group. The picture is the same where nothing casts shadows: most of a robot is behind its own eyes.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._groups = model, model.geom_group.copy()
        self._planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE

    def cull(self, data: mujoco.MjData, camera: str, aspect: float) -> None:
        """Leave what this camera of the model may see, in a picture so many times as wide as high."""
        model, eye = self._model, data.camera(camera)
        slope = tan(radians(model.camera(camera).fovy[0]) / 2) * hypot(1.0, aspect)
        away = data.geom_xpos - eye.xpos
        ahead = -(away @ eye.xmat[2::3])
        aside = np.sqrt(np.maximum((away * away).sum(axis=1) - ahead * ahead, 0.0))
        seen = aside - slope * ahead <= hypot(1.0, slope) * model.geom_rbound
        model.geom_group[:] = np.where(seen | self._planes, self._groups, HIDDEN)
