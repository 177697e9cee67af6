"""One step that catches a fall."""

from collections.abc import Mapping
from math import atan2, pi, sin

import numpy as np

from lumen.features.simulation.falling_sense import FallingSense
from lumen.motion.gait import SIDES, GaitParameters, LegGeometry, Side
from lumen.motion.gait.legs import other
from lumen.motion.gait.parameters import scale_of, time_scale_of
from lumen.motion.gait.swing import CapturePoint, hold_level, landing, smooth

STEP_TIME, STEP_BACK_TIME = 0.17, 0.2
"""The durations of a step forward or to the side, and of a step back [s].

They are for legs as long as those that the step was tuned with.
"""

STEP_HEIGHT = 0.03
"""The height to which a foot is lifted in a step forward or to the side [m], for such legs."""

TOES_PRESS, NEAR_TOES = 0.2, 0.05
"""The maximum angle by which the supporting ankle presses its toes down during the step [rad], and a distance [m].

The toes press fully while the DCM is at the feet's front edge. They do not press if the DCM is farther behind the edge
than that distance: the sole would tip, and the body with it, while the other foot is in the air. Nor do they if the DCM
is as far beyond the edge: they would only make an inevitable fall harder.
"""

KNEE_LIFT, LIFTS_EARLY = 0.25, 0.7
"""The bend of the knee of a foot that steps back [rad], and the exponent of its time: below 1, it comes early."""

KNEE_GIVES, GIVES_LATE = 0.8, 0.15
"""The yielding of the other knee when a foot steps back [rad], and the share of the step at which it begins."""

UPRIGHT_GAIN, UPRIGHT_LEAN = 0.8, 0.45
"""The gain and the target of the torso's forward lean [rad], which the supporting hip controls.

Thighs hardly move backwards (0.48 rad), so a foot can step back only if the torso leans forward.
"""

_LANDS, _LOOK_AHEAD = 0.9, 0.02


_HIP, _KNEE, _ANKLE = 2, 3, 4


class CatchStep:
    """A step of the foot `side` to the place that the body falls towards. It begins at `now` [s].

    `sent` are the angles last sent to the motors [rad]. Call `falling.feel` before each `advance`.
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
        """Return the goals of the legs' joints at `now` [s] as angles [rad]; `measured` are the present angles."""
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
        """Return the angles of a step back: the knee bends first, the torso leans forward and the body is lowered."""
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
        """Add to the angle of one joint of a leg [rad]."""
        joints[self._legs.names[side][role]] += self._legs.signs[side][role] * by

    def _level(self, place: CapturePoint) -> dict[str, float]:
        """Return the angles of the swinging leg that hold its sole level at `place`, relative to the other sole."""
        sole = self._falling.soles[self._rests] + place
        return hold_level(self._legs, self.side, self._falling.axes, sole, self._sent)
