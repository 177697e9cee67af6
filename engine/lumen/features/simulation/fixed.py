"""A robot that is built in where it stands."""

import numpy as np

from lumen.errors import RobotRefusedError
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.contact_shadows import NO_SOLES
from lumen.features.simulation.joint_envelope import JointVector
from lumen.language.commands import Move, Walk
from lumen.robot.executor import Activity


class Fixed:
    """Holds the robot: it neither walks nor falls, and its joints are all that moves."""

    whereabouts = None
    catching = False
    soles = NO_SOLES

    def __init__(self, request: BaseRequest) -> None:
        self._nothing = np.zeros(len(request.body.joints))

    def walk(self, command: Walk | Move, now: float) -> Activity:
        raise RobotRefusedError("the robot can't walk: it has neither legs nor wheels")

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        return self._nothing

    def relax(self) -> None:
        """Nothing moves it."""

    def lose(self, posture: str) -> None:
        """It is where it is."""

    def keep(self, heading: float) -> None:
        """It is where it is."""
