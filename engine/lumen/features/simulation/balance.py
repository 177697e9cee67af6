"""Balance on two feet: by the ankles at all times, by hips and arms against a backward fall."""

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
"""The ankles' correction per rate of the torso [rad per rad/s]; the soles press down on the side of the fall."""

MAX_TRIM = 0.15
_SMOOTHING = 0.3

HIP_SAG, _SAG_SMOOTHING = 0.02, 0.8
"""The hip sag of a leg that alone supports the robot [rad], caused by the servo's lag and the gear's play."""

LEAN, LEAN_RATE, LEAN_GAIN = 0.12, 0.1, 5.0
"""The maximum forward lean by ankles and hips [rad], its maximum rate [rad/s], and its rate per metre [rad/s per m].

The last is per metre by which the weight is too far back, for the leg length with which the paces were tuned.
"""

STANDING_AHEAD = 0.005
"""The distance by which a standing robot keeps its weight farther ahead than in a walk [m], for the same leg length."""

HEEL_MARGIN = 0.01
"""The distance of the DCM from the heels' edge below which the robot falls backwards [m], for the same leg length."""

ARM_SWING, HIP_STRETCH = 3.0, 0.3
"""The arms' swing up and back, and the hips' stretch, against a backward fall [rad]."""

ARM_SPEED, HIP_SPEED = 8.2, 6.0
"""The maximum speeds of the swing and the stretch [rad/s], if the joints reach them."""

ARM_RETURN_TIME, HIP_RETURN_TIME = 1.0, 0.6
"""The durations of the arms' and hips' return [s]: long, because the return pushes the robot backwards again."""


class BalanceController:
    """Corrects the joints' goals by the gyrometer, the encoders and the inertial unit.

    `ahead` is the distance in front of the ankles at which a walk keeps the weight [m]. Before each `trim`, call
    `falling.feel`, set `lifted` to the foot in the air, if any, and set `walking` to True if a walk shifts the weight
    itself. `trim` resets both attributes. `catching` is True while steps catch a fall.
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
        """Return the corrections of the joints' goals [rad] while the torso rolls and pitches at `gyro` [rad/s].

        The array is valid until the next call. Only a robot that is `standing` on its feet leans or swings arms and
        hips.
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
        """Raise the lifted leg's hip by as much as the supporting hip sags, which makes the foot land level."""
        for side, i, sign in self._rolls:
            bears = float(self.lifted is not None and self.lifted != side)
            borne = self._borne[side] = _SAG_SMOOTHING * self._borne[side] + (1 - _SAG_SMOOTHING) * bears
            self._trim[i] = outward(side) * sign * HIP_SAG * borne

    def _catch(self, standing: bool) -> None:
        """Keep the weight over the middle of the soles; swing arms and hips back if the robot falls backwards.

        Arms and hips that turn backwards push the rest of the body forward, over the feet. NAO's heels end 45 mm behind
        its ankles; a push of 2 N s from the front moves the DCM beyond them.
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
    """Return the share (0..1) of a movement against a fall after one more control period."""
    return min(1.0, part + rate * CONTROL_PERIOD) if over else max(0.0, part - CONTROL_PERIOD / back)
