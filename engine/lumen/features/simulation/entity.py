"""The NAO, or another biped, as a dm_control composer entity, for users' own worlds and tasks."""

from collections.abc import Sequence
from pathlib import Path

import lumen.features.simulation.physics  # noqa: F401  # first: reports missing packages

# isort: split
import numpy as np
from dm_control import mjcf
from dm_control.locomotion.walkers import base, legacy_base
from dm_control.locomotion.walkers.initializers import WalkerInitializer

from lumen.features.simulation.model import alone
from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.language.robots import Body
from lumen.language.roles import SIDES

# isort: split
from dm_control import composer
from dm_control.composer.observation import observable


def sole_sensors(body: Body) -> tuple[str, ...]:
    """Return the site names of the force sensors under the soles, the left sole's first."""
    force = body.roles.sensors.force
    return tuple(name for side in SIDES for name in force.get(side, ()))


class NaoObservables(legacy_base.WalkerObservables):  # type: ignore[misc]
    """The observables of a NAO or another biped, in addition to those of any Walker.

    `joints_pos` and `joints_vel` are in the body's order. Observables of missing sensors are left out. The observables
    have no noise: `lumen.features.simulation.imperfections` has the error sizes of real encoders and gyrometers, for an
    observable's `corruptor`.
    """

    def __init__(self, entity: composer.Entity) -> None:
        super().__init__(entity)
        has = {"soles": self._soles(), "camera_top": self._cameras()[:1], "camera_bottom": self._cameras()[1:]}
        for name in [name for name, there in has.items() if not there]:
            del self._observables[name]

    @composer.observable
    def soles(self) -> observable.MJCFFeature:
        """The force on each sensor under the soles [N], in the order of `sole_sensors`."""
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
        """The eye camera's image: uint8, Shape (height, width, 3); Shape (0, 0, 3) if its size is unknown."""
        return self._camera(0)

    @composer.observable
    def camera_bottom(self) -> observable.Observable:
        """The second camera's image: uint8, Shape (height, width, 3); Shape (0, 0, 3) without a second camera."""
        return self._camera(1)

    @property
    def dynamic_sensors(self) -> list[observable.Observable]:
        """The force observables: the sensors under the soles, and those of attached entities."""
        own = [self.soles] if "soles" in self._observables else []
        return [*own, *self._collect_from_attachments("dynamic_sensors")]

    def _soles(self) -> list[mjcf.Element]:
        touch = {s.site.name: s for s in self._entity.mjcf_model.find_all("sensor") if s.tag == "touch"}
        return [touch[name] for name in sole_sensors(self._entity.body) if name in touch]

    def _cameras(self) -> list[mjcf.Element]:
        """Return the model's cameras, the eye camera first."""
        eye = self._entity.body.roles.eyes.camera
        return sorted(self._entity.mjcf_model.find_all("camera"), key=lambda camera: camera.name != eye)

    def _camera(self, which: int) -> observable.Observable:
        seen, cameras = self._entity.body.camera, self._cameras()
        if seen is None or len(cameras) <= which:
            return observable.Generic(lambda physics: np.zeros((0, 0, 3), np.uint8))
        return observable.MJCFCamera(cameras[which], height=seen.height, width=seen.width)


class Nao(legacy_base.Walker):  # type: ignore[misc]  # dm_control has no types
    """The robot alone, a legged Walker: body, motors, sensors and cameras, without a controller or a hall.

    `body` is a project's `project.body`, and `models` is the folder of its MJCF; `name` distinguishes several robots.
    Attach the robot with `nao.create_root_joints(arena.attach(nao))`, or attach its `mjcf_model` to plain MJCF. An
    action has an angle [rad], or a hand's opening (0..1), for each of the `actuators`. An episode that begins with
    `reinitialize_pose` begins in the posture Stand, or as `initializer` sets. Raises RobotError if the model is
    unusable.
    """

    def _build(
        self,
        body: Body,
        models: str | Path,
        name: str = ROBOT_PREFIX,
        initializer: WalkerInitializer | Sequence[WalkerInitializer] | None = None,
    ) -> None:
        super()._build(initializer=initializer)
        self.body, self._models, self._taken = body, Path(models), dict[str, base.WalkerPose]()
        self._mjcf_root = alone(body, Path(models))
        self._mjcf_root.model = name
        # NAO has no velocimeter, but dm_control's tasks compute rewards from one.
        self._mjcf_root.sensor.add("velocimeter", name="velocimeter", site=self._where_it_feels())
        self._prev_action = np.zeros(self.action_spec.shape)

    def _build_observables(self) -> NaoObservables:
        return NaoObservables(self)

    @property
    def mjcf_model(self) -> mjcf.RootElement:
        """The root of the robot's MJCF."""
        return self._mjcf_root

    @property
    def joints(self) -> list[mjcf.Element]:
        """The joints in the body's order."""
        return self._named("joint", list(self.body.joints))

    @property
    def observable_joints(self) -> list[mjcf.Element]:
        """All joints, as observed by `joints_pos` and `joints_vel`."""
        return self.joints

    @property
    def actuators(self) -> list[mjcf.Element]:
        """The motors in the body's order, controlled by angles [rad; hands 0..1].

        A joint moved by another joint's motor has none.
        """
        return self._named("actuator", [name for name in self.body.joints if name not in self.body.shared])

    @property
    def root_body(self) -> mjcf.Element:
        """The torso's link."""
        return self._mjcf_root.find("body", self.body.roles.torso)

    @property
    def end_effectors(self) -> list[mjcf.Element]:
        """The links of the hands and feet."""
        roles = self.body.roles
        ends = [
            list(limbs[side].values())[-1].joint
            for limbs in (roles.arms, roles.legs)
            for side in SIDES
            if side in limbs
        ]
        return [joint.parent for joint in self._named("joint", ends)]

    @property
    def ground_contact_geoms(self) -> list[mjcf.Element]:
        """The soles: the named geoms of the feet."""
        soles = self._named("site", list(self.body.roles.soles.values()))
        return [geom for site in soles for geom in site.parent.geom if geom.name]

    @property
    def egocentric_camera(self) -> mjcf.Element:
        """The eye camera."""
        return self._mjcf_root.find("camera", self.body.roles.eyes.camera)

    @property
    def upright_pose(self) -> base.WalkerPose:
        """The pose of the posture Stand, with the soles on the ground."""
        return self.pose("Stand")

    def take(self, physics: mjcf.Physics, posture: str) -> None:
        """Put the robot into `posture`, upright with its soles on the ground, and make the motors hold this posture.

        Use this to begin an episode.
        """
        qpos, xpos, xquat = self.pose(posture)
        self.configure_joints(physics, qpos)
        self.set_pose(physics, position=xpos, quaternion=xquat)
        self.set_velocity(physics, velocity=np.zeros(3), angular_velocity=np.zeros(3))
        physics.bind(self.actuators).ctrl = self.action_of(posture)

    def action_of(self, posture: str) -> np.ndarray:
        """Return the action that holds `posture` [rad; hands 0..1], in the order of `actuators`."""
        angles = self.body.postures[posture]
        return np.array([angle for name, angle in angles.items() if name not in self.body.shared])

    def apply_action(self, physics: mjcf.Physics, action: np.ndarray, random_state: np.random.RandomState) -> None:
        """Send the action to the motors, and keep it as `prev_action`."""
        super().apply_action(physics, action, random_state)
        self._prev_action[:] = action

    @property
    def prev_action(self) -> np.ndarray:
        """The action of the last step."""
        return self._prev_action

    def aliveness(self, physics: mjcf.Physics) -> float:
        """Return a value from -1, for an upside-down torso, to 0, for an upright torso."""
        return (float(physics.bind(self.root_body).xmat[-1]) - 1.0) / 2.0

    def pose(self, posture: str) -> base.WalkerPose:
        """Return the model's joint angles in `posture`, including coupled joints, and the torso's position.

        The position puts the lowest sole at height 0.
        """
        if posture not in self._taken:
            root = alone(self.body, self._models)  # self may be attached to a world by now
            physics, joints = mjcf.Physics.from_mjcf_model(root), root.find_all("joint")
            angles = self.body.postures[posture]
            led = {equal.joint1.name: equal.joint2.name for equal in root.find_all("equality") if equal.tag == "joint"}
            qpos = [angles.get(j.name, angles.get(led.get(j.name, ""), 0.0)) for j in joints]
            physics.bind(joints).qpos = qpos
            soles = [root.find("site", name) for name in self.body.roles.soles.values()]
            lowest = min(float(physics.bind(site).xpos[2]) for site in soles)
            self._taken[posture] = base.WalkerPose(qpos=qpos, xpos=(0.0, 0.0, -lowest))
        return self._taken[posture]

    def _where_it_feels(self) -> mjcf.Element:
        """Return the gyrometer's site."""
        return self._mjcf_root.find("sensor", self.body.roles.sensors.gyro).site

    def _named(self, kind: str, names: Sequence[str]) -> list[mjcf.Element]:
        return [self._mjcf_root.find(kind, name) for name in names]
