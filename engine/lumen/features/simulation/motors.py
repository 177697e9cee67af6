"""The motors that move the joints."""

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
"""The stall torque [N m] of motors whose stall torque is unknown; infinity would give NaN at a speed of 0."""


class MotorTorques:
    """Each motor's maximum torque as a function of its speed: a line from its stall torque to its no-load speed.

    A motor whose actuator has no stall torque keeps its torque at every speed. So do all motors if `falling` is False.
    `fastest` has the no-load speeds [rad/s] at the battery's nominal voltage, Shape (motors,).
    """

    def __init__(self, world: World, fastest: NDArray[np.float64], *, falling: bool = True) -> None:
        self._world, self._fastest = world, fastest if falling else np.full(len(fastest), np.inf)
        given = world.model.actuator_user[world.actuators]
        stall = given[:, 0] if given.shape[1] else np.zeros(len(fastest))
        self._stall = np.where(stall > 0.0, stall, _WITHOUT_BOUND)

    def limit(self, allowed: NDArray[np.float64], volts: float) -> NDArray[np.float64]:
        """Return each motor's minimum and maximum torque [N m], Shape (motors, 2).

        These are the values `allowed`, Shape (motors, 2), reduced to the torque available from `volts` [V] at the
        present speed.
        """
        supply, limits = volts / NOMINAL_VOLTAGE, np.empty((len(self._stall), 2))
        turning = self._world.motor_speeds / self._fastest
        np.maximum(allowed[:, 0], -self._stall * np.maximum(supply + turning, 0.0), out=limits[:, 0])
        np.minimum(allowed[:, 1], self._stall * np.maximum(supply - turning, 0.0), out=limits[:, 1])
        return limits


LIMP_STIFFNESS = 0.5
"""The stiffness below which a joint counts as limp and can be far from its goal."""


class Motors:
    """Drives every joint to its goal within the body's limits and speeds.

    `goal` has the joints' goals and `command` the angles sent to their servos, both of Shape (joints,) [rad; hands
    0..1]. `effort` has each joint's maximum motor torque [N m], 0 for a joint that another joint's motor moves.
    `voltage` is the supply voltage [V].
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
        """Set the goals of these joints, limited to their ranges.

        Joints that share a motor get the same goal; if both are named, the joint with the motor has priority. Raises
        RobotError, and changes nothing, for an unknown joint or an angle that is not finite.
        """
        self.check(targets)
        for name, angle in targets.items():
            self.goal[self.index[name]] = self.inside(name, angle)
        for follower, leader in self._leader.items():
            if follower in targets and leader not in targets:
                self.goal[self.index[leader]] = self.inside(leader, targets[follower])
            self.goal[self.index[follower]] = self.goal[self.index[leader]]

    def check(self, targets: Mapping[str, float]) -> None:
        """Raise RobotError if a joint is unknown or its angle is not finite."""
        for name, angle in targets.items():
            if name not in self.index:
                raise BadCommandError(f"`{name}` is not a joint of this robot")
            if not isfinite(angle):
                raise BadCommandError(f"`{name}` cannot move to {angle}")

    def inside(self, name: str, angle: float) -> float:
        """Return the nearest angle [rad; hands 0..1] within the joint's limits."""
        low, high = self._limits[name]
        return min(max(angle, low), high)

    def wanted(self, names: Iterable[str]) -> dict[str, float]:
        """Return the goals of these joints [rad; hands 0..1]."""
        return {name: float(self.goal[self.index[name]]) for name in names}

    def unit(self, name: str) -> str:
        """Return `rad ` for a joint that turns, `m ` for a joint that slides; empty for a hand."""
        unit = unit_in_si(name, self._world.body)
        return f"{unit} " if unit else ""

    def lag(self, name: str) -> float:
        """Return the distance between a joint's goal and the angle last sent to its servo [rad]."""
        return self._short.item(self.index[name])

    def held_back(self, name: str) -> float:
        """Return the distance of a joint from the angle sent to its servo [rad].

        A large distance means that the joint is blocked or too weak.
        """
        i = self.index[name]
        return abs(self._world.angles.item(i) - self.command.item(i))

    def sway(self, offsets: Mapping[str, float]) -> None:
        """Add these angles [rad] to the joints' goals in the next control period only."""
        for name, angle in offsets.items():
            self._sway[self.index[name]] += angle

    def hold(self, angles: Mapping[str, float]) -> None:
        """Replace these joints' goals [rad] in the next control period only."""
        self._held = {self.index[name]: angle for name, angle in angles.items()}

    def stiffen(self, stiffness: float, names: Collection[str] | None = None) -> None:
        """Limit these motors, or all if `names` is None, to a share of their torque, from 0 to 1.

        Joints that were limp get their present angles as goals, which prevents jumps.
        """
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
        """Send the servos their angles for the next `dt` [s].

        `trim` [rad] is added to the goals in this period only.
        """
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
        """Limit each motor's torque by its stiffness, its present speed and the supply voltage."""
        volts = self.voltage if self._supplied else NOMINAL_VOLTAGE
        self._world.model.actuator_forcerange[self._world.actuators] = self._torques.limit(self._allowed, volts)
