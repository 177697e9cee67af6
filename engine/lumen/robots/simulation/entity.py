"""The NAO as a building block of dm_control's composer, for worlds and tasks of others."""

from pathlib import Path

from dm_control import composer, mjcf

from lumen.language.robots import Body
from lumen.robots.simulation.model import ROBOT_PREFIX, alone


class Nao(composer.Entity):  # type: ignore[misc]  # dm_control has no types
    """The robot alone: body, motors, sensors and cameras; no controller, no hall.

    `body` and `models` are those of a project (`project.body`, the folder of its MJCF), `name` tells several apart.
    Attach it with `arena.add_free_entity(nao)`, or its `mjcf_model` to a world of plain MJCF. Raises RobotError where
    the model can't be used.
    """

    def _build(self, body: Body, models: str | Path, name: str = ROBOT_PREFIX) -> None:
        self.body = body
        self._root = alone(body, Path(models))
        self._root.model = name

    @property
    def mjcf_model(self) -> mjcf.RootElement:
        return self._root

    @property
    def joints(self) -> list[mjcf.Element]:
        """The joints in NAOqi's order."""
        return [self._root.find("joint", name) for name in self.body.joints]

    @property
    def actuators(self) -> list[mjcf.Element]:
        """The motors, which take angles [rad] and openings, in NAOqi's order; RHipYawPitch has none of its own."""
        return [self._root.find("actuator", name) for name in self.body.joints if name not in self.body.shared]

    def take(self, physics: mjcf.Physics, posture: str) -> None:
        """Be in that posture at once, upright, soles on the ground, and tell the motors to stay: for a beginning."""
        angles = self.body.postures[posture]
        physics.bind(self.joints).qpos = list(angles.values())
        physics.bind(self.actuators).ctrl = [a for name, a in angles.items() if name not in self.body.shared]
        self.set_pose(physics, position=(0.0, 0.0, 1.0), quaternion=(1.0, 0.0, 0.0, 0.0))
        lowest = min(physics.bind(self._root.find("site", f"{side}Sole")).xpos[2] for side in "LR")
        self.set_pose(physics, position=(0.0, 0.0, 1.0 - float(lowest)))
