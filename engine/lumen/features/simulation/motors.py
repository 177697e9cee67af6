"""The only way to a joint."""

from collections import deque
from collections.abc import Collection, Iterable, Mapping
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from lumen.errors import BadCommandError
from lumen.features.simulation.imperfections import FULL_VOLTAGE, LATENCY, NOMINAL_VOLTAGE
from lumen.features.simulation.joint_envelope import JointEnvelope, JointVector
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import World
from lumen.project.units import unit_in_si

_WITHOUT_BOUND = 1e9
"""The stall torque [N m] of a motor that names none; infinity times a speed of 0 would be no number."""


class MotorTorques:
    """The lines from stall torque to no-load speed of all motors.

    A motor whose actuator names no stall torque keeps its torque at every speed; so do all where they are not
    `falling`. `fastest`: no-load speeds [rad/s] at the battery's nominal voltage, Shape (motors,).
    """

    def __init__(self, world: World, fastest: NDArray[np.float64], *, falling: bool = True) -> None:
        self._world, self._fastest = world, fastest if falling else np.full(len(fastest), np.inf)
        given = world.model.actuator_user[world.actuators]
        stall = given[:, 0] if given.shape[1] else np.zeros(len(fastest))
        self._stall = np.where(stall > 0.0, stall, _WITHOUT_BOUND)

    def limit(self, allowed: NDArray[np.float64], volts: float) -> NDArray[np.float64]:
        """Least and greatest torque [N m], Shape (motors, 2): those `allowed`, or what `volts` give at this speed."""
        supply, limits = volts / NOMINAL_VOLTAGE, np.empty((len(self._stall), 2))
        turning = self._world.motor_speeds / self._fastest
        np.maximum(allowed[:, 0], -self._stall * np.maximum(supply + turning, 0.0), out=limits[:, 0])
        np.minimum(allowed[:, 1], self._stall * np.maximum(supply - turning, 0.0), out=limits[:, 1])
        return limits


LIMP_STIFFNESS = 0.5
"""Below this stiffness a joint may be anywhere but at its goal."""


class Motors:
    """Takes goals, and drives every joint there inside the body's limits and speeds.

    `goal` is where the joints are wanted, `command` what is sent to their servos: Shape (joints,), [rad; hands 0..1].
    `effort` is the greatest torque of each motor [N m], 0 at a joint that shares another's; `voltage` feeds them [V].
    """

    def __init__(self, world: World, lacking: Imperfections | None = None) -> None:
        self.body, lacking = world.body, lacking or Imperfections()
        body = self.body
        self._world = world
        self.names = tuple(body.joints)
        self.index = {name: i for i, name in enumerate(self.names)}
        self.envelope = JointEnvelope(body)
        self._leader = dict(body.shared)
        self._limits = {joint.name: (joint.minimum, joint.maximum) for joint in body.joints.values()}
        self._effort = world.model.actuator_forcerange[world.actuators].copy()
        self._torques = MotorTorques(world, self.envelope.speed[world.driven], falling=lacking.torque_speed)
        self._supplied, self.voltage = lacking.supply, FULL_VOLTAGE
        self.effort = np.zeros(len(self.names))
        self.effort[world.driven] = self._effort[:, 1]
        self.stiffness = np.ones(len(self.names))
        self._allowed = self._effort
        self.goal: JointVector = world.angles.copy()
        self.command: JointVector = self.goal.copy()
        self._short: JointVector = np.zeros(len(self.names))
        self._sway = np.zeros(len(self.names))
        self._held: dict[int, float] = {}
        self._sent = deque([self.command], maxlen=LATENCY + 1 if lacking.latency else 1)

    def aim(self, targets: Mapping[str, float]) -> None:
        """Want these joints there, or at their limit where it lies before.

        Raises RobotError, and changes nothing, for an unknown joint or what is no number.
        A joint that shares a motor moves its twin too; where both are named, the one that has the motor decides.
        """
        self.check(targets)
        for name, angle in targets.items():
            self.goal[self.index[name]] = self.inside(name, angle)
        for follower, leader in self._leader.items():
            if follower in targets and leader not in targets:
                self.goal[self.index[leader]] = self.inside(leader, targets[follower])
            self.goal[self.index[follower]] = self.goal[self.index[leader]]

    def check(self, targets: Mapping[str, float]) -> None:
        """Raises RobotError where these are no goals for this body."""
        for name, angle in targets.items():
            if name not in self.index:
                raise BadCommandError(f"`{name}` is not a joint of this robot")
            if not isfinite(angle):
                raise BadCommandError(f"`{name}` cannot move to {angle}")

    def inside(self, name: str, angle: float) -> float:
        """The nearest angle inside that joint's limits."""
        low, high = self._limits[name]
        return min(max(angle, low), high)

    def wanted(self, names: Iterable[str]) -> dict[str, float]:
        """The goals of these joints."""
        return {name: float(self.goal[self.index[name]]) for name in names}

    def unit(self, name: str) -> str:
        """Return `rad ` for a joint that turns, `m ` for one that slides; empty for a hand."""
        unit = unit_in_si(name, self._world.body)
        return f"{unit} " if unit else ""

    def lag(self, name: str) -> float:
        """The distance from the joint's goal to the angle that was sent to its servo in the last period [rad]."""
        return self._short.item(self.index[name])

    def held_back(self, name: str) -> float:
        """The distance of a joint from the angle sent to its servo [rad]: it is obstructed, or too weak."""
        i = self.index[name]
        return abs(self._world.angles.item(i) - self.command.item(i))

    def sway(self, offsets: Mapping[str, float]) -> None:
        """Add that [rad] to the goals of these joints in the next period, and in that alone."""
        for name, angle in offsets.items():
            self._sway[self.index[name]] += angle

    def hold(self, angles: Mapping[str, float]) -> None:
        """Send these joints there [rad] in the next period, and in that alone, instead of to their goals."""
        self._held = {self.index[name]: angle for name, angle in angles.items()}

    def stiffen(self, stiffness: float, names: Collection[str] | None = None) -> None:
        """Let these motors (or all) give at most that part (0..1) of their torque; what was limp starts where it is."""
        chosen = [self.index[name] for name in names] if names is not None else list(self.index.values())
        limp = [i for i in chosen if self.stiffness[i] < LIMP_STIFFNESS]
        if limp:
            angles = self._world.angles
            self.goal[limp] = np.clip(angles, self.envelope.low, self.envelope.high)[limp]
            self.command = self.command.copy()
            self.command[limp] = angles[limp]
            self._sent.clear()
        self.stiffness[chosen] = stiffness
        self._allowed = self.stiffness[self._world.driven, None] * self._effort
        self._limits_of_torque()

    def drive(self, trim: JointVector, dt: float) -> None:
        """Tell the servos where to be `dt` [s] from now; `trim` [rad] is added to the goal, not kept."""
        wanted = self.goal + self._sway
        for joint, angle in self._held.items():
            wanted[joint] = angle
        self.command = self.envelope.step(self.command, wanted + trim, dt)
        self._short = np.abs(wanted + trim - self.command)
        self._sway[:] = 0.0
        self._held = {}
        self._sent.append(self.command)
        self._world.data.ctrl[self._world.actuators] = self._sent[0][self._world.driven]
        self._limits_of_torque()

    def _limits_of_torque(self) -> None:
        """Let each motor give what its stiffness allows, and what it can at the speed it turns at."""
        volts = self.voltage if self._supplied else NOMINAL_VOLTAGE
        self._world.model.actuator_forcerange[self._world.actuators] = self._torques.limit(self._allowed, volts)
