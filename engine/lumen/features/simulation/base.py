"""The interface of a simulated robot's base: its legs, wheels or mount, as named in the roles of its body."""

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
    """The arguments for making a base. Only the base may drive the joints of its legs or wheels."""

    world: World
    models: Path
    """The folder of the robot's MJCF."""
    motors: Motors
    sensors: BodySensors
    imperfections: Imperfections
    hazards: Hazards
    stage: Stage | None
    """The area in which the robot may move; None for no bounds."""
    free: Callable[[str], bool]
    """A function that returns True if no command moves a joint and the motors are on."""
    hot: Callable[[], bool]
    """A function that returns True if a motor is hot and the motors should be spared."""

    @property
    def body(self) -> Body:
        """The robot's body."""
        return self.world.body


class RobotBase(Protocol):
    """A base, which moves the robot if it can, keeps it upright if possible, and estimates its position."""

    @property
    def whereabouts(self) -> Whereabouts | None:
        """The robot's estimated position; None if the base never moves."""

    @property
    def catching(self) -> bool:
        """True if the base is catching a fall."""

    @property
    def soles(self) -> Soles:
        """The robot's soles, under which a film draws shadows."""

    def walk(self, command: Walk | Move, now: float) -> Activity:
        """Begin a walk and return its activity. Raises RobotError, and moves nothing, if the walk must not begin."""

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        """Advance by one control period; return the corrections of the joints' goals [rad] for this period.

        Called only while the motors are on. `upright` is True if the robot's posture is an upright one, `standing` if
        the robot also has not fallen.
        """

    def relax(self) -> None:
        """Advance by one control period with the motors off; called instead of `steady`."""

    def lose(self, posture: str) -> None:
        """Widen the position estimate: the robot is in `posture` or leaving it, or has fallen if `posture` is empty."""

    def keep(self, heading: float) -> None:
        """Update the position estimate: the robot stands, with this heading by the gyrometer [rad]."""
