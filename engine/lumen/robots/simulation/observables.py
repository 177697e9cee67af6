"""What a NAO feels and sees, as observables of dm_control's composer."""

import numpy as np
from dm_control import composer, mjcf
from dm_control.composer.observation import observable
from dm_control.locomotion.walkers import legacy_base

SOLE_SENSORS = tuple(
    f"{side}Foot{corner}" for side in "LR" for corner in ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
)
"""The force sensors under the soles, four of a foot, as NAOqi has them."""


class NaoObservables(legacy_base.WalkerObservables):  # type: ignore[misc]
    """What a NAO feels and sees, besides what any Walker has: `joints_pos` and `joints_vel` are in NAOqi's order.

    Without noise: `lumen.robots.simulation.imperfections` has what encoders and gyrometer of a real one add, as the
    `corruptor` of an observable.
    """

    @composer.observable
    def soles(self) -> observable.MJCFFeature:
        """The force on each of the eight sensors under the soles [N], in the order of `SOLE_SENSORS`."""
        sensors = [self._entity.mjcf_model.find("sensor", name) for name in SOLE_SENSORS]
        return observable.MJCFFeature("sensordata", sensors)

    @composer.observable
    def tilt(self) -> observable.Generic:
        """Roll and pitch of the torso, as the inertial unit's AngleX and AngleY [rad]."""

        def angles(physics: mjcf.Physics) -> np.ndarray:
            forward, left, up = physics.bind(self._entity.root_body).xmat[6:]
            return np.array([np.arctan2(left, up), np.arctan2(-forward, np.hypot(left, up))])

        return observable.Generic(angles)

    @composer.observable
    def camera_top(self) -> observable.MJCFCamera:
        return self._camera("CameraTop")

    @composer.observable
    def camera_bottom(self) -> observable.MJCFCamera:
        return self._camera("CameraBottom")

    @property
    def dynamic_sensors(self) -> list[observable.Observable]:
        """Forces: NAO has those under its soles only."""
        return [self.soles, *self._collect_from_attachments("dynamic_sensors")]

    def _camera(self, name: str) -> observable.MJCFCamera:
        """An image as the robot's own, uint8 of (height, width, 3)."""
        seen, camera = self._entity.body.camera, self._entity.mjcf_model.find("camera", name)
        return observable.MJCFCamera(camera, height=seen.height, width=seen.width)
