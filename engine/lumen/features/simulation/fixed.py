"""A base mounted in one place."""

import numpy as np

from lumen.errors import RobotRefusedError
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.contact_shadows import NO_SOLES
from lumen.features.simulation.joint_envelope import JointVector
from lumen.language.commands import Move, Walk
from lumen.robot.executor import Activity


class Fixed:
    """A mount: the robot can neither walk nor fall, and moves only its joints."""

    whereabouts = None
    catching = False
    soles = NO_SOLES

    def __init__(self, request: BaseRequest) -> None:
        self._nothing = np.zeros(len(request.body.joints))

    def walk(self, command: Walk | Move, now: float) -> Activity:
        """Raise RobotRefusedError: the robot can't walk."""
        raise RobotRefusedError("the robot can't walk: it has neither legs nor wheels")

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        """Return zero corrections: the base needs no balance."""
        return self._nothing

    def relax(self) -> None:
        """Do nothing: the base has no motors."""

    def lose(self, posture: str) -> None:
        """Do nothing: the robot's position is certain."""

    def keep(self, heading: float) -> None:
        """Do nothing: the robot's position is certain."""
