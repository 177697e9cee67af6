"""The robot's battery and its motors' heat."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.imperfections import voltage
from lumen.language.events import Event

BATTERY_CAPACITY = 48.6 * 3600
"""The energy of a full battery [J]: 48.6 Wh, from NAO V5's data sheet."""

IDLE_POWER = 30.0
"""The power of computer and sensors [W]: a charge lasts over an hour and a half of standing and talking."""

CHARGING_POWER = 50.0
"""The charger's power beyond `IDLE_POWER` [W]: an empty battery is full after an hour of rest.

This value is chosen, not measured. Motors reduce the power that is left for charging; beyond it, they draw on the
battery.
"""

STALL_POWER = 6.0
"""The power of a motor at its maximum torque without moving [W]."""

BATTERY_LOW, BATTERY_RECOVERED, BATTERY_USED = 20, 25, 95
"""The charges [%] at which the robot raises `battery.low`, can raise it again, and can raise `battery.full` again."""

MOTOR_HOT, MOTOR_COOLED = 75.0, 70.0
"""The temperatures [degrees Celsius] at which the robot raises `motors.hot`, and can raise it again."""

MOTOR_AMBIENT, MOTOR_RISE, MOTOR_TIME_CONSTANT = 38.0, 300.0, 600.0
"""The motors' initial temperature and final rise at maximum torque [degrees Celsius], and the time constant [s].

These values are chosen, not measured.
"""


class BatteryAndHeat:
    """Integrates the robot's energy use and its motors' heat.

    `efforts` are the joints' maximum torques [N m], and `charge` is the battery's initial charge, from 0 to 1.
    `temperatures` [degrees Celsius] are in the joints' order. `plugged` is true while the charger is in.
    """

    def __init__(self, names: Sequence[str], efforts: Sequence[float], charge: float = 1.0) -> None:
        self._names = names
        self._efforts = np.array(efforts)
        self._energy = charge * BATTERY_CAPACITY
        self.plugged = False
        self._low, self._full = False, charge > BATTERY_USED / 100
        self._hot: set[int] = set()
        self.temperatures: NDArray[np.float64] = np.full(len(names), MOTOR_AMBIENT)

    @property
    def percentage(self) -> int:
        """The battery's charge [%]."""
        return max(0, round(100 * self._energy / BATTERY_CAPACITY))

    @property
    def voltage(self) -> float:
        """The battery's voltage [V]."""
        return voltage(self._energy / BATTERY_CAPACITY)

    @property
    def charging(self) -> bool:
        """True if the charger is in and the battery is not full."""
        return self.plugged and self._energy < BATTERY_CAPACITY

    @property
    def empty(self) -> bool:
        """True if no energy is left for the motors."""
        return self._energy <= 0.0

    @property
    def hot(self) -> bool:
        """True if a motor became hot and has not cooled down since."""
        return bool(self._hot)

    def live(self, torques: NDArray[np.float64], speeds: NDArray[np.float64], dt: float, now: float) -> list[Event]:
        """Advance by `dt` [s] with these torques [N m] and speeds [rad/s]; return battery and motor events."""
        load = np.square(torques / self._efforts)
        power = IDLE_POWER + STALL_POWER * float(load.sum()) + float(np.abs(torques * speeds).sum())
        given = IDLE_POWER + CHARGING_POWER if self.plugged else 0.0
        self._energy = min(max(0.0, self._energy + (given - power) * dt), BATTERY_CAPACITY)
        self.temperatures += (MOTOR_AMBIENT + MOTOR_RISE * load - self.temperatures) * (dt / MOTOR_TIME_CONSTANT)
        return [*self._battery(now), *self._motors(now)]

    def _battery(self, now: float) -> list[Event]:
        self._low = self._low and self.percentage < BATTERY_RECOVERED
        self._full = self._full and self.percentage > BATTERY_USED
        if not self._full and self._energy >= BATTERY_CAPACITY:
            self._full = True
            return [Event("battery.full", {"percentage": 100}, now)]
        if self._low or self.percentage > BATTERY_LOW:
            return []
        self._low = True
        return [Event("battery.low", {"percentage": self.percentage}, now)]

    def _motors(self, now: float) -> list[Event]:
        self._hot = {i for i in self._hot if self.temperatures[i] > MOTOR_COOLED}
        newly = [int(i) for i in np.flatnonzero(self.temperatures >= MOTOR_HOT) if i not in self._hot]
        self._hot.update(newly)
        return [
            Event("motors.hot", {"joint": self._names[i], "temperature": round(float(self.temperatures[i]), 1)}, now)
            for i in newly
        ]
