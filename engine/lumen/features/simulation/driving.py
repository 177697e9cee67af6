"""Driving on two wheels side by side, to a place or at a constant speed, and braking in time."""

from collections.abc import Callable
from math import atan2, copysign, hypot, sqrt

import numpy as np

from lumen.errors import RobotError, RobotFailedError
from lumen.features.simulation.drive_geometry import DriveGeometry
from lumen.features.simulation.hazards import Hazards
from lumen.features.simulation.walking import ARRIVAL_TOLERANCE, HAZARD_CHECK_PERIOD, HEADING_TOLERANCE
from lumen.features.simulation.wheel_odometry import WheelOdometry
from lumen.features.simulation.world import CONTROL_PERIOD, World
from lumen.motion.gait import Pose, Velocity

NEAR, FACING = 0.008, 0.015
"""The tolerances of position [m] and angle [rad] within which the robot neither drives nor turns."""

BACKS_UP = 0.6
"""The maximum distance of a place behind the robot that it reaches in reverse [m]."""

STEERING, CREEPING, CREEPING_TURN = 2.0, 0.03, 0.1
"""The rate of steering back to the path [1/s], and the minimum speeds of a drive [m/s] and of a turn [rad/s]."""

BRAKES_EARLY = 0.85
"""The share used of the speed from which the robot could just stop in time: motors react late."""

MOTORS_LATE = 0.06
"""The delay before a command changes the wheels' speeds [s]."""

STUCK_TIME = 3.0
"""The time without movement after which a drive counts as stuck [s]."""


class Drive:
    """Turns the wheels within the base's speed and acceleration limits; in a period without `steer`, it brakes.

    The argument `limit` is the maximum forward speed [m/s] and turning speed [rad/s]; hot motors halve both.
    """

    def __init__(self, world: World, geometry: DriveGeometry, limit: Velocity, hot: Callable[[], bool]) -> None:
        self._world, self.geometry, self._limit, self._hot = world, geometry, limit, hot
        self.speed = self.turning = 0.0
        self._wanted = 0.0, 0.0

    @property
    def limit(self) -> Velocity:
        """The maximum forward speed [m/s] and turning speed [rad/s]; both are halved while motors are hot."""
        part = 0.5 if self._hot() else 1.0
        return Velocity(part * self._limit.x, 0.0, part * self._limit.theta)

    @property
    def still(self) -> bool:
        """True if the robot neither drives nor turns."""
        return self.speed == 0.0 and self.turning == 0.0

    def steer(self, speed: float, turning: float) -> None:
        """Request a forward speed [m/s] and a turning speed to the left [rad/s] for the next control period."""
        self._wanted = speed, turning

    def turn_wheels(self) -> None:
        """Move the speeds towards the requested speeds and send them to the motors."""
        geometry, most = self.geometry, self.limit
        (speed, turning), self._wanted = self._wanted, (0.0, 0.0)
        self.speed = _toward(self.speed, min(max(speed, -most.x), most.x), geometry.acceleration)
        self.turning = _toward(self.turning, min(max(turning, -most.theta), most.theta), geometry.spin)
        apart = self.turning * geometry.track / 2
        rolling = np.array((self.speed - apart, self.speed + apart))
        rolling *= min(1.0, geometry.fastest / max(float(np.abs(rolling).max()), 1e-9))
        self._world.data.ctrl[geometry.motors] = geometry.signs * rolling / geometry.radius

    def halt(self) -> None:
        """Stop the wheels as hard as the motors can."""
        self.speed = self.turning = 0.0
        self._wanted = 0.0, 0.0
        self._world.data.ctrl[self.geometry.motors] = 0.0


class DriveActivity:
    """A drive in progress. A hazard or the stage's edge ends it by braking, as `cancel` does."""

    def __init__(self, drive: Drive, odometry: WheelOdometry, hazards: Hazards, now: float) -> None:
        self.drive, self.odometry, self._hazards = drive, odometry, hazards
        self._look = now + HAZARD_CHECK_PERIOD
        self._now = now
        self._reason = ""
        self._cancelled = False

    def advance(self, now: float) -> bool:
        """Steer for the control period at `now` [s]; return True when the robot has arrived or stopped.

        Raises RobotFailedError if a hazard or the stage's edge stopped the robot, or if it did not reach its goal.
        """
        self._now = now
        if not self._cancelled and now >= self._look:
            self._look += HAZARD_CHECK_PERIOD
            self._reason = self._hazards.danger() or self._leaves()
            self._cancelled = bool(self._reason)
        if not self._cancelled:
            return self._go(now)
        if not self.drive.still:
            return False
        if self._reason:
            raise RobotFailedError(f"{self._reason}: the drive was stopped")
        return True

    def cancel(self) -> None:
        """Brake; the drive ends when the robot is still."""
        self._cancelled = True

    def _go(self, now: float) -> bool:
        """Steer for one control period; return True at the end of the drive."""
        raise NotImplementedError

    def _leaves(self) -> str:
        """Return the reason why the robot must not reach its stopping place if it brakes now; empty if it may."""
        speed, here = self.drive.speed, self.odometry.here
        late = HAZARD_CHECK_PERIOD + MOTORS_LATE
        comes = speed * late + speed * abs(speed) / (2 * self.drive.geometry.acceleration)
        try:
            self.odometry.check(here.then(Pose(comes)))
        except RobotError as error:
            return str(error)
        return ""


class DriveOn(DriveActivity):
    """A drive at a constant velocity, which `change` can alter on the way."""

    def __init__(self, drive: Drive, odometry: WheelOdometry, hazards: Hazards, wanted: Velocity, now: float) -> None:
        super().__init__(drive, odometry, hazards, now)
        self._wanted = wanted

    def change(self, wanted: Velocity, now: float) -> bool:
        """Continue at this velocity and return True; return False if the drive is ending or not advanced to `now`."""
        alive = self._now == now and not self._cancelled
        if alive:
            self._wanted = wanted
        return alive

    def _go(self, now: float) -> bool:
        self.drive.steer(self._wanted.x, self._wanted.theta)
        return not any(self._wanted) and self.drive.still


class DriveTo(DriveActivity):
    """A drive to a place: turn towards it, drive there, and turn to the goal's heading.

    The robot drives backwards to a nearby place behind it.
    """

    def __init__(self, drive: Drive, odometry: WheelOdometry, hazards: Hazards, goal: Pose, now: float) -> None:
        super().__init__(drive, odometry, hazards, now)
        self._goal = goal
        seen = goal.seen_from(odometry.here)
        far = hypot(seen.x, seen.y)
        self._back = seen.x < 0 and far <= BACKS_UP and abs(seen.y) < abs(seen.x)
        self._phase = self._face if far > NEAR else self._turn
        self._been, self._since = odometry.here, now

    def _go(self, now: float) -> bool:
        seen = self._goal.seen_from(self.odometry.here)
        gone = self.odometry.here.seen_from(self._been)
        if hypot(gone.x, gone.y) > NEAR or abs(gone.theta) > FACING:
            self._been, self._since = self.odometry.here, now
        stuck = now - self._since > STUCK_TIME
        if not stuck and not self._phase(seen):
            return False
        far, turned = hypot(seen.x, seen.y), abs(seen.theta)
        if stuck or far > ARRIVAL_TOLERANCE or turned > HEADING_TOLERANCE:
            raise RobotFailedError(
                f"the robot did not reach its target: it is {100 * far:.0f} cm and {turned:.2f} rad away"
            )
        return True

    def _face(self, seen: Pose) -> bool:
        """Turn the front, or the back, towards the goal; always return False."""
        bearing = atan2(-seen.y, -seen.x) if self._back else atan2(seen.y, seen.x)
        if self._round(bearing):
            self._phase = self._approach
        return False

    def _approach(self, seen: Pose) -> bool:
        """Drive to the goal, correcting sideways errors while enough distance remains; always return False."""
        ahead = -1.0 if self._back else 1.0
        left, drive = ahead * seen.x, self.drive
        if left < NEAR:
            if drive.still:
                self._phase = self._turn
            return False
        aside = STEERING * atan2(ahead * seen.y, left) if left > ARRIVAL_TOLERANCE else 0.0
        speed = _braking(left, drive.limit.x, drive.geometry.acceleration, CREEPING)
        drive.steer(ahead * speed, aside)
        return False

    def _turn(self, seen: Pose) -> bool:
        """Turn to the goal's heading; return True when done."""
        return self._round(seen.theta)

    def _round(self, angle: float) -> bool:
        """Turn by this angle [rad]; return True when done."""
        drive = self.drive
        if abs(angle) < FACING:
            return drive.still
        drive.steer(0.0, copysign(_braking(abs(angle), drive.limit.theta, drive.geometry.spin, CREEPING_TURN), angle))
        return False


def _braking(left: float, most: float, rate: float, least: float) -> float:
    """Return the maximum speed from which the robot can stop within the distance `left`, between `least` and `most`.

    `rate` is the deceleration. The values are either all linear [m] or all angular [rad].
    """
    return min(most, max(least, BRAKES_EARLY * sqrt(2 * rate * left)))


def _toward(speed: float, wanted: float, rate: float) -> float:
    """Return `speed` after one control period, changed towards `wanted` by at most `rate` per second."""
    step = rate * CONTROL_PERIOD
    return min(max(wanted, speed - step), speed + step)
