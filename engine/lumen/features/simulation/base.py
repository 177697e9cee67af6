"""What a simulated robot stands on and moves about with: a base is made for the kind that its body has."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from lumen.features.simulation.contact_shadows import Soles
from lumen.features.simulation.hazards import Hazards
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import World
from lumen.language.commands import Move, Walk
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.ports import Whereabouts
from lumen.robot.executor import Activity


@dataclass(frozen=True)
class BaseRequest:
    """A request for the base of a robot; `models` is the folder of its MJCF. Only its world and motors move it."""

    world: World
    models: Path
    motors: Motors
    sensors: BodySensors
    imperfections: Imperfections
    hazards: Hazards
    stage: Stage | None
    """The ground on which the robot may go; None if nothing bounds it."""
    free: Callable[[str], bool]
    """Whether nothing else moves a joint, and it has power."""
    hot: Callable[[], bool]
    """Whether the motors should be spared."""

    @property
    def body(self) -> Body:
        return self.world.body


class RobotBase(Protocol):
    """Walks or drives, keeps the robot upright as far as it can, and knows where it believes to be."""

    @property
    def whereabouts(self) -> Whereabouts | None:
        """Where the robot believes to be; None for one that never moves from its place."""

    @property
    def catching(self) -> bool:
        """Whether a fall is being caught."""

    @property
    def soles(self) -> Soles:
        """Its soles, for what a film draws beneath them."""

    def walk(self, command: Walk | Move, now: float) -> Activity:
        """The walk under way. Raises RobotError, and moves nothing, for one that must not begin."""

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        """What to add to the joints' goals [rad] in this control period.

        `upright` is whether the robot means to be on its feet, `standing` whether it is. For periods with motors on.
        """

    def relax(self) -> None:
        """The motors are off in this control period."""

    def lose(self, posture: str) -> None:
        """The robot is down, in that posture or on its way from it; or it has fallen, where that is empty."""

    def keep(self, heading: float) -> None:
        """The robot stands, heading there as the gyrometer feels it [rad]."""
