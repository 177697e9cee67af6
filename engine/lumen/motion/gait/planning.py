"""The bearing point during a step, planned so that the body arrives where the next step begins."""

from collections.abc import Sequence
from dataclasses import dataclass

from lumen.motion.gait.footsteps import Feet, Footstep
from lumen.motion.gait.legs import Side, other, sign
from lumen.motion.gait.parameters import GaitParameters
from lumen.motion.gait.pendulum import Pendulum
from lumen.motion.gait.poses import Pose
from lumen.motion.gait.swing import Swing


@dataclass(slots=True)
class GaitPhase:
    """A step, or the settling after the last step."""

    zmp: list[complex]
    """The bearing point at each tick, x + iy [m]."""
    swing: Swing | None = None
    """The path of the moving foot; None while both feet stay."""
    lifts: int = 0
    """The tick at which the foot leaves the ground."""
    last: bool = False
    """Whether it is the last step, after which the weight is between the feet."""
    tick: int = 0
    """The number of ticks that have passed."""

    @property
    def over(self) -> bool:
        """Whether the last tick has passed."""
        return self.tick == len(self.zmp)

    @property
    def part(self) -> float:
        """The part of its path that the foot in the air will have covered after this tick."""
        return (self.tick + 1 - self.lifts) / max(1, len(self.zmp) - self.lifts)

    @property
    def lifted(self) -> Side | None:
        """The foot in the air; None if both are on the ground."""
        return self.swing.side if self.swing and self.tick >= self.lifts else None


class StepPlanner:
    """Plans phases in ticks of `dt` [s]; points are x + iy [m]."""

    def __init__(self, pace: GaitParameters, pendulum: Pendulum, dt: float) -> None:
        self._pace, self._pendulum = pace, pendulum
        self._double, self._single = round(pace.double / dt), round(pace.single / dt)
        self._shift, self._settle = round(pace.shift / dt), round(pace.settle / dt)

    def step(self, feet: Feet, steps: Sequence[Footstep], dcm: complex, zmp: complex, *, standing: bool) -> GaitPhase:
        """Return the phase of the first of these steps, which prepares for the others; a single step is the last.

        A robot that was `standing` needs additional time to shift its weight.
        """
        side, goal = steps[0]
        wait = self._shift if standing else 0
        rests = bearing_point(feet, other(side), self._pace)
        weight = [zmp] * wait + _ramp(zmp, rests, self._double) + [rests] * self._single
        swing = Swing(side, feet[side], goal, self._pace.lift)
        weight = self._shifted(weight, dcm, self._end(feet, steps), feet[other(side)], self._pace.sole_aside)
        return GaitPhase(weight, swing, wait + self._double, len(steps) == 1)

    def settle(self, feet: Feet, dcm: complex, zmp: complex) -> GaitPhase:
        """Return a phase in which both feet stay and the weight moves between them."""
        end = between(feet, self._pace)
        weight = _ramp(zmp, end, self._double) + [end] * (self._settle - self._double)
        return GaitPhase(self._shifted(weight, dcm, end, feet["L"], self._pace.apart / 2))

    def divert(self, phase: GaitPhase, feet: Feet, goal: Pose, dcm: complex) -> None:
        """Redirect the moving foot to `goal`, as the last step."""
        assert phase.swing
        side = phase.swing.side
        phase.swing.turn(max(phase.part, 0.0), goal)
        end = self._end(feet, [Footstep(side, goal)])
        weight = phase.zmp[phase.tick :]
        phase.zmp[phase.tick :] = self._shifted(weight, dcm, end, feet[other(side)], self._pace.sole_aside)
        phase.last = True

    def _end(self, feet: Feet, steps: Sequence[Footstep]) -> complex:
        """Return the DCM needed at the end of the first of these steps."""
        pace, feet = self._pace, {**feet, steps[0].side: steps[0].pose}
        last, weight = bearing_point(feet, other(steps[0].side), pace), list[complex]()
        for side, pose in steps[1:]:
            rests = bearing_point(feet, other(side), pace)
            weight += _ramp(last, rests, self._double) + [rests] * self._single
            feet, last = {**feet, side: pose}, rests
        end = between(feet, pace)
        return self._pendulum.backward(weight + _ramp(last, end, self._double), end)

    def _shifted(self, zmp: list[complex], dcm: complex, end: complex, foot: Pose, aside: float) -> list[complex]:
        """Return these points, shifted to bring the body from `dcm` to `end`, within the sole of `foot`."""
        shift = self._pendulum.shift(dcm, zmp, end) / foot.ahead
        most = self._pace.sole_ahead
        x = min(max(shift.real, -most), most)
        y = min(max(shift.imag, -aside), aside)
        return [point + complex(x, y) * foot.ahead for point in zmp]


def bearing_point(feet: Feet, side: Side, pace: GaitParameters) -> complex:
    """Return the point of that foot on which the weight rests."""
    return feet[side].place + complex(pace.ahead, -sign(side) * pace.inside) * feet[side].ahead


def between(feet: Feet, pace: GaitParameters) -> complex:
    """Return the point between the feet on which the weight rests."""
    return (bearing_point(feet, "L", pace) + bearing_point(feet, "R", pace)) / 2


def _ramp(start: complex, end: complex, ticks: int) -> list[complex]:
    """Return points from `start` (excluded) to `end` (included)."""
    return [start + (end - start) * (k + 1) / ticks for k in range(ticks)]
