"""Observables of dm_control's composer for NAO's sensors."""

import lumen.features.simulation.physics  # noqa: F401  # first: names what is not installed

# isort: split
import numpy as np
from dm_control import composer, mjcf
from dm_control.composer.observation import observable
from dm_control.locomotion.walkers import legacy_base

from lumen.language.robots import Body
from lumen.language.roles import SIDES


def sole_sensors(body: Body) -> tuple[str, ...]:
    """Return the names of the sites of the force sensors under the soles, the left sole's first."""
    force = body.roles.sensors.force
    return tuple(name for side in SIDES for name in force.get(side, ()))


class NaoObservables(legacy_base.WalkerObservables):  # type: ignore[misc]
    """The observables of a NAO or another biped besides those of any Walker; `joints_pos` and `joints_vel` are in the
    body's order. Observables of missing sensors are left out.

    They have no noise: `lumen.features.simulation.imperfections` has the errors of real encoders and gyrometers, to be
    used as the `corruptor` of an observable.
    """

    def __init__(self, entity: composer.Entity) -> None:
        super().__init__(entity)
        has = {"soles": self._soles(), "camera_top": self._cameras()[:1], "camera_bottom": self._cameras()[1:]}
        for name in [name for name, there in has.items() if not there]:
            del self._observables[name]

    @composer.observable
    def soles(self) -> observable.MJCFFeature:
        """The force on each of the sensors under the soles [N], in the order of `sole_sensors`."""
        return observable.MJCFFeature("sensordata", self._soles())

    @composer.observable
    def tilt(self) -> observable.Generic:
        """The torso's roll and pitch, like the inertial unit's AngleX and AngleY [rad]."""

        def angles(physics: mjcf.Physics) -> np.ndarray:
            forward, left, up = physics.bind(self._entity.root_body).xmat[6:]
            return np.array([np.arctan2(left, up), np.arctan2(-forward, np.hypot(left, up))])

        return observable.Generic(angles)

    @composer.observable
    def camera_top(self) -> observable.Observable:
        """The image of the camera that the robot sees with: uint8, Shape (height, width, 3)."""
        return self._camera(0)

    @composer.observable
    def camera_bottom(self) -> observable.Observable:
        """The image of the other camera, if the model has one."""
        return self._camera(1)

    @property
    def dynamic_sensors(self) -> list[observable.Observable]:
        """The observables of forces: those under the soles."""
        own = [self.soles] if "soles" in self._observables else []
        return [*own, *self._collect_from_attachments("dynamic_sensors")]

    def _soles(self) -> list[mjcf.Element]:
        touch = {s.site.name: s for s in self._entity.mjcf_model.find_all("sensor") if s.tag == "touch"}
        return [touch[name] for name in sole_sensors(self._entity.body) if name in touch]

    def _cameras(self) -> list[mjcf.Element]:
        """Return the model's cameras, the one that the robot sees with first."""
        eye = self._entity.body.roles.eyes.camera
        return sorted(self._entity.mjcf_model.find_all("camera"), key=lambda camera: camera.name != eye)

    def _camera(self, which: int) -> observable.Observable:
        seen, cameras = self._entity.body.camera, self._cameras()
        if seen is None or len(cameras) <= which:
            return observable.Generic(lambda physics: np.zeros((0, 0, 3), np.uint8))
        return observable.MJCFCamera(cameras[which], height=seen.height, width=seen.width)
