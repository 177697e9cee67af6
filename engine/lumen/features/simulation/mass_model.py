"""The robot's own model of its weight: the published masses, without any load."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotModelError
from lumen.features.simulation.physics import mujoco
from lumen.language.robots import Body
from lumen.language.roles import SIDES
from lumen.project.packaged_models import mjcf_path


class MassModel:
    """The robot's model without a world, for computing centres of mass."""

    def __init__(self, body: Body, models: Path) -> None:
        try:
            spec = mujoco.MjSpec.from_file(str(mjcf_path(body.mjcf, models)))
            spec.compiler.discardvisual = True
            for name, link in body.links.items():
                differs = spec.body(name)
                differs.mass, differs.ipos, differs.fullinertia = link.mass, link.centre, link.inertia
            self.model: mujoco.MjModel = spec.compile()
        except ValueError as error:
            raise RobotModelError(f"{body.mjcf} is not MJCF: {' '.join(str(error).split())}") from error
        self._data = mujoco.MjData(self.model)
        self._places = {name: self.model.joint(name).qposadr[0] for name in body.joints}
        self._torso = self.model.body(body.roles.torso).id
        at, turned = self.model.body_pos[self._torso], self.model.body_quat[self._torso]
        root = self.model.body_parentid[self._torso] == 0 and not self.model.body_jntnum[self._torso]
        self._torso_is_world = bool(root and not at.any() and turned[0] == 1.0)
        self._whole = self.model.body_rootid[self._torso]
        self._order = np.array(list(self._places.values()))
        soles = [body.roles.soles[side] for side in SIDES if side in body.roles.soles]
        self._soles = np.array([self.model.site(name).id for name in soles], np.intp)

    def pose(self, angles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the centre of mass (3,) and the points of both soles below the ankles (2, 3) [m], in the torso's
        frame.

        `angles` are those of all joints in the body's order [rad].
        """
        self._data.qpos[self._order] = angles
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        return self._seen(self._data.subtree_com[self._whole]), self._seen(
            self._data.site_xpos.take(self._soles, axis=0)
        )

    def centre_of_mass(self, angles: Mapping[str, float]) -> NDArray[np.float64]:
        """Return the centre of mass (3,) [m] in the torso's frame; joints not in `angles` [rad] keep their last
        value.
        """
        for name, angle in angles.items():
            self._data.qpos[self._places[name]] = angle
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        return self._seen(self._data.subtree_com[self._whole])

    def _seen(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points of the world, Shape (..., 3), in the torso's frame [m]."""
        if self._torso_is_world:
            return points.copy()
        seen: NDArray[np.float64] = (points - self._data.xpos[self._torso]) @ self._data.xmat[self._torso].reshape(3, 3)
        return seen
