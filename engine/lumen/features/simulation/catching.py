"""Steps that catch a fall too strong for ankles, hips and arms, after which the robot continues its activity."""

from collections.abc import Callable, Mapping

from lumen.features.simulation.balance import BalanceController
from lumen.features.simulation.catch_step import CatchStep
from lumen.features.simulation.falling_sense import FallingSense
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.odometry import Odometry
from lumen.features.simulation.sensors import BodySensors
from lumen.motion.gait import SIDES, CentreOfMass, Gait, LegGeometry, Paces, Side, Velocity, middle
from lumen.motion.gait.parameters import scale_of, time_scale_of
from lumen.motion.gait.swing import smooth

BEYOND_TOES, BEYOND_HEELS = -0.01, -0.008
"""The distances of the DCM beyond the feet's front and rear edges above which a step begins [m].

They are for the leg length with which the step was tuned. A sideways fall starts no step, since feet can't cross.
"""

ASIDE = 0.008
"""The sideways distance of the DCM above which steps catch a backward fall [m].

In a straight backward fall, both feet stay loaded, and arms and hips help more than a foot that can't leave the
ground.
"""

BRACE_TIME, CALM_TIME, RETURN_TIME = 0.5, 0.3, 1.0
"""The times to bring the body between the feet, to rest there, and to return the legs to their goals [s]."""

NEXT_STEP = 0.2
"""The minimum pause between two steps [s]."""

MOST_STEPS = 4
"""The maximum number of steps to catch one fall."""


class FallCatcher:
    """Controls the legs while it catches a fall; the motors keep the legs' earlier goals.

    The robot takes one or more steps in the direction of the fall, rests with bent legs, and steps until its feet are
    side by side again. Then a walk continues; for any other activity, the legs return slowly to their goals.
    """

    def __init__(
        self,
        motors: Motors,
        sensors: BodySensors,
        falling: FallingSense,
        balance: BalanceController,
        odometry: Odometry,
        com: CentreOfMass,
        legs: LegGeometry,
        paces: Paces,
    ) -> None:
        self._motors, self._sensors, self._falling, self._balance = motors, sensors, falling, balance
        self._odometry, self._com = odometry, com
        self._geometry, self._pace = legs, paces.catching
        self._scale, self._slow = scale_of(legs), time_scale_of(legs)
        self._names = [name for side in SIDES for name in legs.names[side]]
        self._since = 0.0
        self._steps, self._north = 0, 0.0
        self._step: CatchStep | None = None
        self._gait: Gait | None = None
        self._landed: dict[str, float] = {}
        self._legs: Mapping[str, float] = {}
        self._does: Callable[[float], None] | None = None

    @property
    def active(self) -> bool:
        """True if a fall is being caught."""
        return self._does is not None

    def advance(self, now: float, *, standing: bool) -> None:
        """Begin or continue to catch a fall at `now` [s]; stop if the robot is not `standing` on its feet."""
        if not standing:
            self._does = None
            return
        if self._does is None and self._needed:
            self._steps = 0
            self._set_out(now)
        if self._does:
            self._does(now)
            self._motors.hold(self._legs)
        self._balance.catching = self.active

    @property
    def _needed(self) -> bool:
        ahead, behind, _, _ = self._falling.beyond
        return ahead > BEYOND_TOES * self._scale or (
            behind > BEYOND_HEELS * self._scale and abs(self._falling.aside) > ASIDE * self._scale
        )

    def _measured(self) -> dict[str, float]:
        """Return the legs' measured joint angles [rad]."""
        angles, index = self._sensors.angles, self._motors.index
        return {name: float(angles[index[name]]) for name in self._names}

    def _sent(self) -> dict[str, float]:
        return {name: float(self._motors.command[self._motors.index[name]]) for name in self._names}

    def _set_out(self, now: float) -> None:
        """Begin a step with the foot that is already in the air, else with the foot farther from the DCM."""
        far = self._falling.far
        side: Side = self._balance.lifted or ("L" if far[0] > far[1] else "R")
        if not self._steps:
            self._north = middle(self._odometry.feel(self._measured())).theta - self._sensors.heading
        self._step = CatchStep(self._geometry, self._pace, self._falling, side, self._sent(), now)
        self._steps += 1
        self._does = self._swing

    def _swing(self, now: float) -> None:
        assert self._step
        measured = self._measured()
        self._legs = self._step.advance(now, measured)
        self._balance.lifted = self._step.side
        if self._step.over(now):
            bearing = self._odometry.feet[self._step.bears]
            landed = bearing.then(self._geometry.foot_from(self._step.bears, measured))
            self._odometry.land({self._step.bears: bearing, self._step.side: landed})
            self._landed, self._since = self._sent(), now
            self._gait = Gait(self._geometry, self._odometry.feet, Velocity(), self._com, self._pace)
            self._does = self._brace

    def _brace(self, now: float) -> None:
        """Bring the body between the feet; step again if the robot is still falling."""
        assert self._gait
        gone = now - self._since
        if gone > NEXT_STEP * self._slow and max(self._falling.beyond) > 0.0 and self._steps < MOST_STEPS:
            self._set_out(now)
        elif gone > (BRACE_TIME + CALM_TIME) * self._slow:
            feet = self._odometry.feel(self._measured())
            self._gait = Gait(self._geometry, feet, Velocity(), self._com, self._pace)
            self._does = self._follow
        else:
            part = smooth(gone / (BRACE_TIME * self._slow))
            end = self._gait.angles
            self._legs = {name: angle + part * (end[name] - angle) for name, angle in self._landed.items()}

    def _follow(self, now: float) -> None:
        """Bring the feet together, as at the end of a walk, then resume the walk or return the legs to their goals."""
        assert self._gait
        walks, self._balance.walking = self._balance.walking, True
        tick = self._gait.tick(self._measured(), self._sensors.heading)
        if tick:
            self._legs, self._balance.lifted = tick.angles, tick.lifted
            return
        self._odometry.land(self._gait.feet)
        self._odometry.stumble(self._north + self._sensors.heading)
        self._landed, self._since = dict(self._legs), now
        self._does = None if walks else self._return
        if walks:
            self._motors.aim(self._legs)

    def _return(self, now: float) -> None:
        """Move the legs back to their goals."""
        part = smooth((now - self._since) / RETURN_TIME)
        wanted = self._motors.wanted(self._names)
        self._legs = {name: angle + part * (wanted[name] - angle) for name, angle in self._landed.items()}
        if part == 1.0:
            self._does = None
