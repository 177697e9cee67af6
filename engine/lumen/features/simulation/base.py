"""What a simulated robot stands on and moves about with: a base is made for the kind that its body has."""

from typing import Protocol

from lumen.features.simulation.contact_shadows import Soles
from lumen.features.simulation.joint_envelope import JointVector
from lumen.language.commands import Move, Walk
from lumen.ports import Whereabouts
from lumen.robot.executor import Activity


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
