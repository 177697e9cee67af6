"""Walking, to a place or continuously: NAOqi's `moveTo` and `move`."""

from collections.abc import Callable, Mapping
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from lumen.errors import BadCommandError, RobotError, RobotFailedError, RobotRefusedError
from lumen.features.simulation.balance import BalanceController
from lumen.features.simulation.falling_sense import MassModel
from lumen.features.simulation.hazards import Hazards
from lumen.features.simulation.joint_transition import JointTransition
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.odometry import Odometry
from lumen.features.simulation.sensors import BodySensors
from lumen.language.commands import Move, Walk
from lumen.language.roles import Roles
from lumen.motion.gait import (
    SIDES,
    Gait,
    GaitParameters,
    LegGeometry,
    Paces,
    Pose,
    Velocity,
    middle,
)
from lumen.motion.gait.legs import SIDE_ROLES, sign
from lumen.motion.gait.parameters import scale_of

MAX_WALK_DISTANCE = 10.0
"""The longest accepted walk [m]."""

MAX_STAGE_DRIFT = 0.02
"""The maximum distance of later planned steps beyond the stage [m]: each foot lands slightly off its plan."""

ARRIVAL_TOLERANCE, HEADING_TOLERANCE = 0.02, 0.05
"""The distance [m] and the angle [rad] from its goal beyond which a finished walk has failed."""

WALK_POSTURE_TIME, WALK_REST_TIME = 0.8, 0.2
"""The time to reach the walk's posture, and to come to rest there [s]."""

HAZARD_CHECK_PERIOD = 0.1
"""The time between two checks for hazards [s]."""

ARM_SWING_GAIN, MAX_ARM_SWING, HANGING_ARM_PITCH = 2.5, 0.35, 1.0
"""The arms' swing per metre between the feet [rad/m], its maximum [rad], and the pitch of hanging arms [rad].

The first value is for the leg length with which the paces were tuned. Arms hang above the pitch.
"""


def way_of(command: Walk | Move) -> Pose | Velocity:
    """Return a walk's goal relative to the robot, or its velocity.

    Raises RobotError if a value is not finite, or if the goal is too far.
    """
    if isinstance(command, Move):
        velocity = Velocity(command.vx, command.vy, command.vtheta)
        if not all(map(isfinite, velocity)):
            raise BadCommandError(f"the robot cannot walk at ({velocity.x}, {velocity.y}, {velocity.theta})")
        return velocity
    x, y, theta = command.x, command.y, command.theta
    if not all(map(isfinite, (x, y, theta))):
        raise BadCommandError(f"there is no way to ({x}, {y}, {theta})")
    if abs(complex(x, y)) > MAX_WALK_DISTANCE:
        raise BadCommandError(f"({x:g}, {y:g}) is too far: walk at most {MAX_WALK_DISTANCE:g} m")
    return Pose(x, y, theta)


class WalkController:
    """Controls walks; `begin` returns a command's activity.

    `free` returns True if no command moves a joint and the motors are on, `hot` if the motors should be spared.
    """

    def __init__(
        self,
        motors: Motors,
        balance: BalanceController,
        sensors: BodySensors,
        odometry: Odometry,
        mass_model: MassModel,
        legs: LegGeometry,
        paces: Paces,
        roles: Roles,
        hazards: Hazards,
        free: Callable[[str], bool],
        hot: Callable[[], bool],
    ) -> None:
        self.motors, self.balance, self.sensors = motors, balance, sensors
        self.odometry, self.hazards = odometry, hazards
        self._mass_model, self._free, self._hot = mass_model, free, hot
        self.legs, self._paces = legs, paces
        names = {name for side in SIDES for name in legs.names[side]}
        self._legs = [(name, i) for name, i in motors.index.items() if name in names]
        self._others = [name for name in motors.names if name not in names]
        arms = [(sign(side), roles.joint(f"arms.{SIDE_ROLES[side]}.shoulder-pitch")) for side in SIDES]
        self._arms = [(role.joint, role.sign, side) for side, role in arms if role]
        self._arm_gain = ARM_SWING_GAIN / scale_of(legs)
        self._walking: WalkActivity | None = None

    def begin(self, command: Walk | Move, now: float) -> "WalkActivity":
        """Begin a walk and return its activity.

        If a walk at a velocity is in progress, a new velocity changes that walk. Raises RobotError, and moves nothing,
        if the walk must not begin.
        """
        way = way_of(command)
        if isinstance(way, Velocity) and self._walking and self._walking.steer(way, now):
            return self._walking
        return self._set_out(way, now)

    def _set_out(self, way: Pose | Velocity, now: float) -> "WalkActivity":
        if reason := self.hazards.danger():
            raise RobotRefusedError(f"{reason}: the robot did not start walking")
        measured = self.measured()
        feet = self.odometry.feel(measured)
        goal = way if isinstance(way, Velocity) else middle(feet).then(way)
        gait = Gait(self.legs, feet, goal, self.centre_of_mass, self.pace(way))
        gait.face(measured, self.sensors.heading)
        self.odometry.check(gait.coming)
        self._walking = WalkActivity(self, gait, now)
        return self._walking

    def pace(self, way: Pose | Velocity, now: GaitParameters | None = None) -> GaitParameters:
        """Return the gentle pace if motors are hot, the brisk pace for velocities that need it, else the usual pace.

        A walk to a place is never brisk, for an accurate end. A walk at a velocity that is brisk `now` stays brisk,
        because frequent changes of pace make the robot stumble.
        """
        usual, gentle, brisk, _ = self._paces
        if self._hot():
            return gentle
        return brisk if isinstance(way, Velocity) and (now == brisk or way.within(usual) != way) else usual

    def measured(self) -> dict[str, float]:
        """Return the legs' joint angles measured by the encoders [rad]."""
        angles = self.sensors.angles
        return {name: float(angles[i]) for name, i in self._legs}

    def swing(self, stride: float) -> None:
        """Swing hanging, free arms opposite to the legs; `stride` is the left foot's lead [m]."""
        angle = min(max(self._arm_gain * stride, -MAX_ARM_SWING), MAX_ARM_SWING)
        hanging = self.motors.wanted(name for name, _, _ in self._arms)
        self.motors.sway(
            {
                name: way * side * angle
                for name, way, side in self._arms
                if way * hanging[name] > HANGING_ARM_PITCH and self._free(name)
            }
        )

    def centre_of_mass(self, legs: Mapping[str, float]) -> NDArray[np.float64]:
        """Return the centre of mass in the torso's frame [m], Shape (3,), with these leg angles [rad].

        All other joints are at their goals.
        """
        return self._mass_model.centre_of_mass({**self.motors.wanted(self._others), **legs})


class WalkActivity:
    """A walk: into the walking posture, a short rest, and steps until the goal is reached or the walk is ended."""

    def __init__(self, walker: WalkController, gait: Gait, now: float) -> None:
        self._walker, self._gait, self._now = walker, gait, now
        self._rising: JointTransition | None = JointTransition(walker.motors, gait.angles, now, WALK_POSTURE_TIME)
        self._steady = now
        self._look = now + HAZARD_CHECK_PERIOD
        self._landed = 0
        self._reason = ""
        self._cancelled = self._over = self._stumbled = False

    def steer(self, velocity: Velocity, now: float) -> bool:
        """Change the velocity; return False if the walk has no velocity, is ending, or was not advanced to `now`."""
        alive = self._now == now and not self._cancelled and not self._over
        goes_on = alive and isinstance(self._gait.goal, Velocity)
        if goes_on:
            self._gait.goal = velocity
            self._gait.hasten(self._walker.pace(velocity, self._gait.pace))
        return goes_on

    def advance(self, now: float) -> bool:
        """Continue until `now` [s]; return True at the end.

        Raises RobotFailedError if a hazard or the stage's edge stopped the walk, or if the walk missed its goal.
        """
        self._now = now
        self._walker.balance.walking = True
        if self._walker.balance.catching:
            self._stumbled = True
            return False
        if self._stumbled and self._go_on(now):
            return True
        self._watch(now)
        if self._rising:
            return self._rise(self._rising, now)
        if now < self._steady:
            return False
        return self._go()

    def cancel(self) -> None:
        """End the walk with the feet together."""
        self._cancelled = True
        if self._rising:
            self._rising.cancel()
        else:
            self._gait.stop()

    def _go_on(self, now: float) -> bool:
        """Continue from the feet's present poses after a caught fall; return True if a cancelled walk ends there."""
        walker, gait = self._walker, self._gait
        self._stumbled, self._landed = False, 0
        self._gait = Gait(walker.legs, walker.odometry.feet, gait.goal, walker.centre_of_mass, gait.pace)
        if self._cancelled:
            return self._end()
        self._rising = JointTransition(walker.motors, self._gait.angles, now, WALK_POSTURE_TIME)
        return False

    def _rise(self, rising: JointTransition, now: float) -> bool:
        if rising.advance(now):
            self._rising, self._steady = None, now + WALK_REST_TIME
            return self._cancelled and self._end()
        return False

    def _go(self) -> bool:
        walker = self._walker
        tick = self._gait.tick(walker.measured(), walker.sensors.heading)
        if tick is None:
            return self._end()
        walker.odometry.pass_by(self._gait.feet)
        walker.motors.aim(tick.angles)
        walker.swing(tick.stride)
        walker.balance.lifted = tick.lifted
        return False

    def _watch(self, now: float) -> None:
        """Cancel the walk if a hazard appears or the planned steps leave the stage."""
        if self._cancelled:
            return
        if now >= self._look:
            self._look += HAZARD_CHECK_PERIOD
            self._reason = self._walker.hazards.danger()
        if self._gait.steps > self._landed and not self._reason:
            self._landed = self._gait.steps
            try:
                drift = 0.0 if isinstance(self._gait.goal, Velocity) else MAX_STAGE_DRIFT
                self._walker.odometry.check(self._gait.coming, drift)
            except RobotError as error:
                self._reason = str(error)
        if self._reason:
            self.cancel()

    def _end(self) -> bool:
        self._over = True
        self._walker.odometry.land(self._gait.feet)
        if self._reason:
            raise RobotFailedError(f"{self._reason}: the walk was stopped")
        far, turned = self._gait.left
        if not self._cancelled and (far > ARRIVAL_TOLERANCE or turned > HEADING_TOLERANCE):
            raise RobotFailedError(
                f"the robot did not reach its target: it is {100 * far:.0f} cm and {turned:.2f} rad away"
            )
        return True
