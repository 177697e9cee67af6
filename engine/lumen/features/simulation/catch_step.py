"""A single step to catch a fall."""

from collections.abc import Mapping
from math import atan2, pi, sin

import numpy as np

from lumen.features.simulation.falling_sense import FallingSense
from lumen.motion.gait import SIDES, GaitParameters, LegGeometry, Side
from lumen.motion.gait.legs import other
from lumen.motion.gait.parameters import scale_of, time_scale_of
from lumen.motion.gait.swing import CapturePoint, hold_level, landing, smooth

STEP_TIME, STEP_BACK_TIME = 0.17, 0.2
"""The durations of a forward and a backward step [s], for the leg length with which the step was tuned."""

STEP_HEIGHT = 0.03
"""The height to which the foot is lifted in a forward step [m], for the same leg length."""

TOES_PRESS, NEAR_TOES = 0.2, 0.05
"""The maximum angle by which the supporting ankle presses its toes down in a step [rad], and a distance limit [m].

The toes press fully when the DCM reaches the feet's front edge. They don't press if the DCM is farther behind the edge
than the limit, because the sole and the body would tip while the other foot is in the air. They don't press either if
the DCM is that far beyond the edge, because they would make an inevitable fall harder.
"""

KNEE_LIFT, LIFTS_EARLY = 0.25, 0.7
"""The knee bend of the leg that steps back [rad], and the exponent of its time: below 1, the knee bends early."""

KNEE_GIVES, GIVES_LATE = 0.8, 0.15
"""The bend of the supporting knee in a step back [rad], and the share of the step at which it begins."""

UPRIGHT_GAIN, UPRIGHT_LEAN = 0.8, 0.45
"""The gain and the target [rad] of the torso's forward lean, which the supporting hip controls.

Thighs hardly move backwards (0.48 rad), so a foot can step back only if the torso leans forward.
"""

_LANDS, _LOOK_AHEAD = 0.9, 0.02


_HIP, _KNEE, _ANKLE = 2, 3, 4


class CatchStep:
    """A step of the foot `side`, beginning at `now` [s], to the place towards which the body is falling.

    `sent` has the angles last sent to the motors [rad]. Call `falling.feel` before each `advance`.
    """

    def __init__(
        self,
        legs: LegGeometry,
        pace: GaitParameters,
        falling: FallingSense,
        side: Side,
        sent: Mapping[str, float],
        now: float,
    ) -> None:
        self._legs, self._pace, self._falling = legs, pace, falling
        self.side, self.bears = side, other(side)
        self._swings, self._rests = SIDES.index(side), SIDES.index(self.bears)
        self._begin, self._back = now, falling.beyond[1] > falling.beyond[0]
        scale = scale_of(legs)
        self._height, self._near, self._presses = STEP_HEIGHT * scale, NEAR_TOES * scale, 0.0
        self._seconds = (STEP_BACK_TIME if self._back else STEP_TIME) * time_scale_of(legs)
        self._sent = dict(sent)
        self._start = falling.soles[self._swings] - falling.soles[self._rests]

    def advance(self, now: float, measured: Mapping[str, float]) -> dict[str, float]:
        """Return the legs' goal angles [rad] at `now` [s]; `measured` has the present angles [rad]."""
        gone = now - self._begin
        part = min(1.0, (gone + _LOOK_AHEAD) / self._seconds)
        falling, left = self._falling, max(self._seconds - gone, 0.0)
        goal = landing(self._legs, self._pace, falling.dcm[self._rests], falling.omega, left, self.bears)
        if self._back:
            return self._step_back(part, goal, measured)
        done = smooth(part / _LANDS)
        place = self._start[:2] + (goal - self._start[:2]) * done
        height = self._start[2] * (1 - done) + self._height * sin(pi * part) ** 2
        joints = {**self._sent, **self._level(np.array([*place, height]))}
        ahead = falling.beyond[0] / self._near
        self._presses = max(self._presses, min(1.0, 1.0 + ahead)) if ahead < 1.0 else 0.0
        self._turn(joints, self.bears, _ANKLE, TOES_PRESS * self._presses)
        return joints

    def over(self, now: float) -> bool:
        """Return True if the foot should have landed by `now` [s]."""
        return now - self._begin >= self._seconds

    def _step_back(self, part: float, goal: CapturePoint, measured: Mapping[str, float]) -> dict[str, float]:
        """Return the angles of a step back [rad]: the knee bends first, the torso leans forward, and the body sinks."""
        side, bears, sent = self.side, self.bears, self._sent
        end, way = self._level(np.array([*goal, 0.0])), min(1.0, part / _LANDS)
        joints = {**sent, **{n: sent[n] + way * (angle - sent[n]) for n, angle in end.items()}}
        lift = KNEE_LIFT * sin(pi * part**LIFTS_EARLY)
        self._turn(joints, side, _KNEE, lift)
        self._turn(joints, side, _ANKLE, -lift)
        up = self._falling.axes[2]
        leant = atan2(up[0], up[2])
        hip = self._legs.names[bears][_HIP]
        joints[hip] = measured[hip]
        self._turn(joints, bears, _HIP, -UPRIGHT_GAIN * (leant + UPRIGHT_LEAN))
        gives = KNEE_GIVES * smooth(max(part - GIVES_LATE, 0.0) / (1 - GIVES_LATE))
        self._turn(joints, bears, _HIP, -gives / 2)
        self._turn(joints, bears, _KNEE, gives)
        self._turn(joints, bears, _ANKLE, -gives / 2)
        return joints

    def _turn(self, joints: dict[str, float], side: Side, role: int, by: float) -> None:
        """Add `by` [rad], in the role's usual direction, to the angle of one leg joint."""
        joints[self._legs.names[side][role]] += self._legs.signs[side][role] * by

    def _level(self, place: CapturePoint) -> dict[str, float]:
        """Return the swinging leg's angles [rad] that hold its sole level at `place` [m] relative to the other sole."""
        sole = self._falling.soles[self._rests] + place
        return hold_level(self._legs, self.side, self._falling.axes, sole, self._sent)
