"""A base with two driven wheels: the robot drives instead of walking, and tips over if pushed hard."""

import numpy as np

from lumen.errors import RobotRefusedError
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.contact_shadows import NO_SOLES, Soles
from lumen.features.simulation.drive_geometry import read_drive
from lumen.features.simulation.driving import Drive, DriveOn, DriveTo
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.walking import way_of
from lumen.features.simulation.wheel_odometry import WheelOdometry
from lumen.features.simulation.world import CONTROL_PERIOD
from lumen.language.commands import Move, Walk
from lumen.motion.gait import Velocity
from lumen.ports import Whereabouts
from lumen.robot.executor import Activity


class Wheels:
    """Two wheels side by side under a torso. Raises RobotModelError if the robot can't drive on them."""

    catching = False

    def __init__(self, request: BaseRequest) -> None:
        world, base, drive = request.world, request.body.roles.base, read_drive(request.world)
        limit = Velocity(min(base.speed, drive.fastest), 0.0, min(base.turn, 2 * drive.fastest / drive.track))
        self.drive = Drive(world, drive, limit, request.hot)
        self.odometry = WheelOdometry(world, request.sensors, drive, request.imperfections, request.stage)
        self._hazards, self._nothing = request.hazards, np.zeros(len(request.body.joints))
        self._on: DriveOn | None = None

    @property
    def whereabouts(self) -> Whereabouts:
        """The robot's estimated pose and the possible error."""
        return self.odometry.whereabouts

    @property
    def soles(self) -> Soles:
        """An empty mapping: wheels have no soles."""
        return NO_SOLES

    def walk(self, command: Walk | Move, now: float) -> Activity:
        """Begin a drive, or change the present drive's speed, and return its activity.

        Raises RobotError for an invalid goal, a sideways speed, a hazard, or a place beyond the stage.
        """
        way = way_of(command)
        if isinstance(way, Velocity):
            return self._move(way, now)
        self._ready()
        goal = self.odometry.here.then(way)
        self.odometry.check(goal)
        return DriveTo(self.drive, self.odometry, self._hazards, goal, now)

    def _move(self, wanted: Velocity, now: float) -> Activity:
        if wanted.y:
            raise RobotRefusedError("a robot on wheels cannot drive sideways: turn first")
        if self._on and self._on.change(wanted, now):
            return self._on
        self._ready()
        self._on = DriveOn(self.drive, self.odometry, self._hazards, wanted, now)
        return self._on

    def _ready(self) -> None:
        if reason := self._hazards.danger():
            raise RobotRefusedError(f"{reason}: the robot did not start driving")

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        """Turn the wheels as steered, or brake if the robot is not standing; return zero corrections for the joints."""
        self.odometry.feel(CONTROL_PERIOD)
        if standing:
            self.drive.turn_wheels()
        else:
            self.drive.halt()
        return self._nothing

    def relax(self) -> None:
        """Update the odometry and brake: wheels stay locked while the motors are off."""
        self.odometry.feel(CONTROL_PERIOD)
        self.drive.halt()

    def lose(self, posture: str) -> None:
        """Widen the position estimate if the robot has fallen, which an empty `posture` means."""
        if not posture:
            self.odometry.lose()

    def keep(self, heading: float) -> None:
        """Inform the odometry that the robot stands."""
        self.odometry.keep()
