"""A walk to a place, or with a given velocity, tick by tick; planned anew from each landed foot."""

from collections.abc import Callable, Mapping
from math import atan2, hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.motion.gait.footsteps import Feet, Footstep, Velocity, first_side, footsteps, middle, strides
from lumen.motion.gait.legs import SIDES, LegGeometry, Placed, Side, other, sign, torso_rotation
from lumen.motion.gait.parameters import GaitParameters
from lumen.motion.gait.pendulum import Pendulum
from lumen.motion.gait.planning import GaitPhase, StepPlanner, between
from lumen.motion.gait.poses import Pose, wrap
from lumen.motion.gait.stance import Stance, stand


class StepTracker:
    """Estimates the pose of the bearing foot from step to step.

    While both feet are on the ground, the joint angles give the position of one foot relative to the other; a foot that
    lands still slides a little then. The direction comes from the gyrometer, counted from `feet` and `heading` [rad] at
    the beginning: soles turn on the floor without any change in the encoders, little in each step, but degrees in a
    hundred. `measured` are the angles of the legs [rad].
    """

    def __init__(self, legs: LegGeometry, feet: Feet, measured: Mapping[str, float], heading: float) -> None:
        self._legs, self._seen = legs, list[Pose]()
        left, right = (wrap(feet[side].theta - self._yaw(side, measured)) for side in SIDES)
        self._north = heading - left - wrap(right - left) / 2

    def look(self, next_side: Side, measured: Mapping[str, float]) -> None:
        """Add a measurement while both feet are on the ground; `next_side` is the foot that leaves the ground next."""
        self._seen.append(self._legs.foot_from(next_side, measured))

    def stands(self, bearing: Side, feet: Feet, measured: Mapping[str, float], heading: float) -> Pose:
        """Return the pose of the foot that bore the step that ends now; `feet` are the estimates from its beginning."""
        place = feet[bearing].place
        if self._seen:
            x, y, _ = np.mean(self._seen, axis=0).tolist()
            place = feet[other(bearing)].then(Pose(x, y)).place
        self._seen.clear()
        return Pose(place.real, place.imag, heading - self._north + self._yaw(bearing, measured))

    def _yaw(self, side: Side, measured: Mapping[str, float]) -> float:
        """Return the heading of that foot relative to the torso [rad]."""
        turned, _ = self._legs.sole(side, measured)
        return atan2(turned[1, 0], turned[0, 0])


CentreOfMass = Callable[[Mapping[str, float]], NDArray[np.float64]]
"""A function that returns the centre of mass (3,) [m] in the torso's frame, for these leg angles [rad]."""

GOAL_TOLERANCE, GOAL_HEADING_TOLERANCE = 0.008, 0.02
"""Accepted distance from the goal at the end of a walk [m], [rad]."""

_SIDE_BY_SIDE = Pose(0.015, 0.015, 0.06)
_FORESIGHT, _MORE, _LATEST = 3, 8, 0.5
_TORSO_TO_MASS = (0.01, 0.0, -0.05)


class GaitTick(NamedTuple):
    """The output of a tick of the gait."""

    angles: Mapping[str, float]
    """The angles of the legs' joints [rad]."""
    lifted: Side | None
    """The foot in the air; None if both are on the ground."""
    stride: float
    """The lead of the left foot [m]."""


class Gait:
    """A walk to `goal`; `feet` and `goal` are in the same frame, which can be any on the ground.

    If `goal` is a velocity, the robot walks with it until stopped, or until `goal` becomes zero. `goal` may be changed
    during the walk; the steps planned next follow it gradually.

    `angles` are the initial leg angles on these feet before the first step. Then `tick`, called every `dt` [s], returns
    the next angles; `heading` is the planned heading of the torso [rad]. The poses of the feet are estimated from the
    measured leg angles and the torso's measured heading, relative to the last call of `face`.
    """

    def __init__(
        self,
        legs: LegGeometry,
        feet: Feet,
        goal: Pose | Velocity,
        com: CentreOfMass,
        pace: GaitParameters,
        dt: float = 0.01,
    ) -> None:
        self._legs = legs
        self.goal: Pose | Velocity = goal
        self.feet, self.pace, self.steps = feet, pace, 0
        self._com, self._dt = com, dt
        self._stopping, self._speed = False, Velocity()
        self._side = first_side(goal.seen_from(middle(feet)) if isinstance(goal, Pose) else Pose(*goal))
        self._most = 2 * len(self.coming) + _MORE if isinstance(goal, Pose) else inf
        self._tracker: StepTracker | None = None
        self._mass = self._dcm = self._zmp = between(feet, self.pace)
        self.heading, self._offset = middle(feet).theta, np.array(_TORSO_TO_MASS)
        # The centre of mass depends on the stance, and the stance on the offset of that centre: a few rounds converge
        for _ in range(4):
            stance = self._stand({side: Placed(pose) for side, pose in feet.items()})
        self.angles: Mapping[str, float] = stance.angles
        self._pendulum = Pendulum(self.pace.torso + float(self._offset[2]), dt)
        self._planner = StepPlanner(self.pace, self._pendulum, dt)
        self._phase = self._settle() if self._arrived(feet) else self._step(standing=True)

    def hasten(self, pace: GaitParameters) -> None:
        """Use another pace from the next step on; it must carry the torso at the same height."""
        self.pace, self._planner = pace, StepPlanner(pace, self._pendulum, self._dt)

    @property
    def left(self) -> tuple[float, float]:
        """The estimated distance from the goal [m] and turn to it [rad]; zeros if the goal is a velocity."""
        if isinstance(self.goal, Velocity):
            return 0.0, 0.0
        way = self.goal.seen_from(middle(self.feet))
        return hypot(way.x, way.y), abs(way.theta)

    @property
    def coming(self) -> list[Footstep]:
        """The remaining steps as planned now; for a velocity, the next step and a step that ends the walk."""
        if isinstance(self.goal, Velocity):
            step = strides(self.feet, self._speed, self._side, self.pace, 1)[0]
            return [step, self._beside(step.pose, other(step.side))]
        return footsteps(self.feet, self.goal, self._side, self.pace)

    def face(self, measured: Mapping[str, float], heading: float) -> None:
        """Assume that the present estimates of the feet are right; leg angles and heading are as for `tick`."""
        self._tracker = StepTracker(self._legs, self.feet, measured, heading)

    def tick(self, measured: Mapping[str, float], heading: float) -> GaitTick | None:
        """Return the next output for the legs; None once the robot stands.

        `measured` are the present leg angles, `heading` is the torso's heading, from any fixed zero [rad].
        """
        if self._tracker is None:
            self.face(measured, heading)
        if self._phase.over and not self._go_on(measured, heading):
            return None
        phase = self._phase
        feet = {side: Placed(pose) for side, pose in self.feet.items()}
        lifted = phase.lifted
        if phase.swing and lifted:
            feet[lifted] = phase.swing.at(phase.part)
        elif self._tracker and phase.swing:
            self._tracker.look(phase.swing.side, measured)
        self._zmp = phase.zmp[phase.tick]
        self._mass, self._dcm = self._pendulum.fall(self._mass, self._dcm, self._zmp)
        phase.tick += 1
        stride = feet["L"].pose.seen_from(feet["R"].pose).x
        return GaitTick(self._stand(feet).angles, lifted, stride)

    def stop(self) -> None:
        """End the walk as soon as balance permits.

        A foot that just took off returns; a foot that is farther on its way lands first.
        """
        phase, stopping = self._phase, self._stopping
        self._stopping = True
        if stopping or phase.swing is None:
            return
        if self.steps == 0 and not phase.lifted:
            self._phase = self._settle()
        elif not phase.lifted or phase.part < _LATEST:
            self._planner.divert(phase, self.feet, self._closing().pose, self._dcm)

    def _go_on(self, measured: Mapping[str, float], heading: float) -> bool:
        """Begin the next phase; return False at the end of the walk."""
        last = self._phase.last
        if self._phase.swing:
            self._land(self._phase.swing.goal, measured, heading)
            self._phase = self._settle() if last else self._step(standing=False)
        elif self._stopping or self._arrived(self.feet) or self.steps >= self._most:
            return False
        else:
            self._phase = self._step(standing=True)
        return True

    def _land(self, planned: Pose, measured: Mapping[str, float], heading: float) -> None:
        """Update the feet from the joints after a landing, and move all planned points along."""
        assert self._tracker
        side, bearing = self._side, other(self._side)
        stood = self._tracker.stands(bearing, self.feet, measured, heading)
        landed = stood.then(self._legs.foot_from(bearing, measured))
        self.feet = {bearing: stood, side: landed}

        def moved(point: complex) -> complex:
            return landed.place + (point - planned.place) * (landed.ahead / planned.ahead)

        self._mass, self._dcm, self._zmp = moved(self._mass), moved(self._dcm), moved(self._zmp)
        self.heading += landed.theta - planned.theta
        self._side, self.steps = bearing, self.steps + 1

    def _arrived(self, feet: Feet) -> bool:
        seen = feet["L"].seen_from(feet["R"])
        together = (seen.x, seen.y - self.pace.apart, seen.theta)
        side_by_side = all(abs(a) < b for a, b in zip(together, _SIDE_BY_SIDE, strict=True))
        if isinstance(self.goal, Velocity):
            return side_by_side and not any(self.goal)
        way = self.goal.seen_from(middle(feet))
        return hypot(way.x, way.y) < GOAL_TOLERANCE and abs(way.theta) < GOAL_HEADING_TOLERANCE and side_by_side

    def _step(self, *, standing: bool) -> GaitPhase:
        if isinstance(self.goal, Velocity):
            self._speed = self._speed.toward(self.goal, self.pace) if any(self.goal) else Velocity()
        return self._planner.step(self.feet, self._next(), self._dcm, self._zmp, standing=standing)

    def _settle(self) -> GaitPhase:
        return self._planner.settle(self.feet, self._dcm, self._zmp)

    def _next(self) -> list[Footstep]:
        """Return the next steps; if there is only one, it is the last."""
        if self._stopping:
            return [self._closing()]
        if isinstance(self.goal, Velocity) and any(self.goal):
            return strides(self.feet, self._speed, self._side, self.pace, _FORESIGHT)
        steps = self.coming[:_FORESIGHT]
        ends = self.steps >= self._most or self._arrived({**self.feet, self._side: steps[0].pose})
        return steps[:1] if ends else steps

    def _closing(self) -> Footstep:
        """Return the step of the next foot to a place beside the other one."""
        return self._beside(self.feet[other(self._side)], self._side)

    def _beside(self, bearing: Pose, side: Side) -> Footstep:
        return Footstep(side, bearing.then(Pose(0.0, sign(side) * self.pace.apart)))

    def _stand(self, feet: Mapping[Side, Placed]) -> Stance:
        """Return the joints that bring the centre of mass to its planned position."""
        pace = self.pace
        torso = self._mass - complex(self._offset[0], self._offset[1])
        stance = stand(self._legs, torso, pace.torso, pace.lean, self.heading, feet)
        self.heading = stance.yaw
        self._offset = torso_rotation(stance.yaw, pace.lean) @ self._com(stance.angles)
        return stance
