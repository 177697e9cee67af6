"""Steadies the robot on its feet: with its ankles all the time, with hips and arms when it falls backwards."""

import numpy as np

from lumen.features.simulation.falling_sense import FallingSense
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.world import CONTROL_PERIOD
from lumen.language.roles import Roles
from lumen.motion.gait import SIDES, LegGeometry, Side
from lumen.motion.gait.legs import SIDE_ROLES
from lumen.motion.gait.legs import sign as outward
from lumen.motion.gait.parameters import scale_of

BALANCE_GAIN = 0.05
"""Ankle angle for each unit of the torso's turning speed [rad per rad/s]: the toes press where it falls to."""

MAX_TRIM = 0.15
_SMOOTHING = 0.3

HIP_SAG, _SAG_SMOOTHING = 0.02, 0.8
"""How far the hip of a leg that bears alone gives way [rad]: its servo lags by 2 N m, and its gear has play."""

LEAN, LEAN_RATE, LEAN_GAIN = 0.12, 0.1, 5.0
"""How far ankles and hips lean forward at most [rad], how fast [rad/s], and that for each metre [rad/s per m]; the last
on legs as long as those that paces were found with."""

STANDING_AHEAD = 0.005
"""So much farther ahead than in a walk the weight is wanted while the robot stands [m], on such legs."""

HEEL_MARGIN = 0.01
"""The DCM is falling backwards nearer than this to the heels' edge [m], on such legs."""

ARM_SWING, HIP_STRETCH = 3.0, 0.3
"""How far arms swing up and back, and hips stretch, against a fall [rad]."""

ARM_SPEED, HIP_SPEED = 8.2, 6.0
"""How fast they do [rad/s] where the joints can."""

ARM_RETURN_TIME, HIP_RETURN_TIME = 1.0, 0.6
"""How long they take back [s], slowly: what they gave they take again."""


class BalanceController:
    """Trims the joints' goals by what gyrometer, encoders and inertial unit feel.

    `lifted` is the foot in the air, `walking` whether a walk shifts the weight itself; both for one trim. `catching` is
    whether steps catch a fall; `falling` has to feel before each trim. A walk has the weight `ahead` of the ankles [m].
    """

    def __init__(self, motors: Motors, falling: FallingSense, legs: LegGeometry, roles: Roles, ahead: float) -> None:
        def joint(side: Side, role: int) -> tuple[int, float]:
            return motors.index[legs.names[side][role]], legs.signs[side][role]

        self._ankles = [[(side, *joint(side, role)) for side in SIDES] for role in (5, 4)]
        self._hips = [joint(side, 2) for side in SIDES]
        self._rolls = [(side, *joint(side, 1)) for side in SIDES]
        self._borne = dict.fromkeys(SIDES, 0.0)
        arms = [roles.joint(f"arms.{SIDE_ROLES[side]}.shoulder-pitch") for side in SIDES]
        self._shoulders = [(motors.index[arm.joint], arm.sign) for arm in arms if arm]
        speed = motors.envelope.speed
        self._arm_speed = min([ARM_SPEED, *(float(speed[i]) for i, _ in self._shoulders)])
        self._hip_speed = min([HIP_SPEED, *(float(speed[i]) for i, _ in self._hips)])
        scale = scale_of(legs)
        self._ahead = ahead + STANDING_AHEAD * scale
        self._heel_margin, self._lean_gain = HEEL_MARGIN * scale, LEAN_GAIN / scale
        self._falling = falling
        self._trim = np.zeros(len(motors.names))
        self._felt = [0.0, 0.0]
        self._lean = self._swing = self._stretch = 0.0
        self.lifted: Side | None = None
        self.walking = self.catching = False

    def trim(self, gyro: tuple[float, float], *, standing: bool) -> JointVector:
        """What to add to the joints' goals [rad] while the torso rolls and pitches like this [rad/s].

        Valid until called again. A robot that is not `standing` on its feet has nothing to lean or to catch.
        """
        for axis, rate in enumerate(gyro):
            felt = self._felt[axis] = _SMOOTHING * self._felt[axis] + (1 - _SMOOTHING) * rate
            angle = min(max(BALANCE_GAIN * felt, -MAX_TRIM), MAX_TRIM)
            for side, i, sign in self._ankles[axis]:
                self._trim[i] = 0.0 if side == self.lifted else sign * angle
        self._bear()
        self._catch(standing and not (self.walking or self.catching))
        self.lifted, self.walking = None, False
        return self._trim

    def _bear(self) -> None:
        """Raise the hip that the leg in the air hangs from, as far as the bearing one gives way: it lands level."""
        for side, i, sign in self._rolls:
            bears = float(self.lifted is not None and self.lifted != side)
            borne = self._borne[side] = _SAG_SMOOTHING * self._borne[side] + (1 - _SAG_SMOOTHING) * bears
            self._trim[i] = outward(side) * sign * HIP_SAG * borne

    def _catch(self, standing: bool) -> None:
        """Carry the weight over the middle of the soles; swing arms and hips backwards where the robot falls there.

        What turns backwards pushes the rest forward, over the feet: a NAO's heels end 45 mm behind its ankles, which a
        push of 2 N s from the front carries the DCM beyond.
        """
        over = standing and self._falling.behind_heels > -self._heel_margin
        rate = self._lean_gain * (self._ahead - self._falling.ahead) if standing else -LEAN_RATE
        self._lean += min(max(rate, -LEAN_RATE), LEAN_RATE) * CONTROL_PERIOD
        self._lean = min(max(self._lean, 0.0), LEAN)
        self._swing = _toward(over, self._swing, self._arm_speed / ARM_SWING, ARM_RETURN_TIME)
        self._stretch = _toward(over, self._stretch, self._hip_speed / HIP_STRETCH, HIP_RETURN_TIME)
        for i, sign in self._shoulders:
            self._trim[i] = -sign * ARM_SWING * self._swing
        for i, sign in self._hips:
            self._trim[i] = sign * (HIP_STRETCH * self._stretch + self._lean)
        for _, i, sign in self._ankles[1]:
            self._trim[i] -= sign * self._lean


def _toward(over: bool, part: float, rate: float, back: float) -> float:
    """The part (0..1) of a movement against a fall, a control period later."""
    return min(1.0, part + rate * CONTROL_PERIOD) if over else max(0.0, part - CONTROL_PERIOD / back)
