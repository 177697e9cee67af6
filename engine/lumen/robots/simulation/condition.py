"""How the robot fares: battery and the heat of its motors."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lumen.language.events import Event

CAPACITY = 48.6 * 3600
"""A full battery [J]: 48.6 Wh, from NAO V5's data sheet."""

IDLE_POWER = 30.0
"""What computer and sensors take [W]; so that a charge lasts a good hour and a half of standing and talking."""

CHARGING_POWER = 50.0
"""What the charger gives [W]; so that an empty battery is full after an hour, if the robot rests. Chosen, not measured.

While plugged in, the robot lives on the charger, and motors that take more take the rest from the battery.
"""

LOSS = 6.0
"""What a motor takes [W] to give its greatest torque without moving."""

LOW, RECHARGED, USED = 20, 25, 95
"""Charge [%] at which the robot speaks up, may do so again, and may say again that the battery is full."""

HOT, COOLED = 75.0, 70.0
"""Temperatures [degrees Celsius] at which the robot speaks up, and may do so again."""

AMBIENT, RISE, TIME_CONSTANT = 38.0, 300.0, 600.0
"""Where motors begin, how far they heat up at their greatest torque, in what time [s]. Chosen, not measured."""


class Condition:
    """Integrates what the motors do; `temperatures` [degrees Celsius] in the order of the joints.

    `plugged` is whether the charger is in.
    """

    def __init__(self, names: Sequence[str], efforts: Sequence[float], charge: float = 1.0) -> None:
        self._names = names
        self._efforts = np.array(efforts)
        self._energy = charge * CAPACITY
        self.plugged = False
        self._low, self._full = False, charge > USED / 100
        self._hot: set[int] = set()
        self.temperatures: NDArray[np.float64] = np.full(len(names), AMBIENT)

    @property
    def percentage(self) -> int:
        return max(0, round(100 * self._energy / CAPACITY))

    @property
    def charging(self) -> bool:
        """Whether the charger is in and the battery takes more."""
        return self.plugged and self._energy < CAPACITY

    @property
    def empty(self) -> bool:
        """Whether there is nothing left for the motors."""
        return self._energy <= 0.0

    @property
    def hot(self) -> bool:
        """Whether a motor has spoken up and not cooled down since."""
        return bool(self._hot)

    def live(self, torques: NDArray[np.float64], speeds: NDArray[np.float64], dt: float, now: float) -> list[Event]:
        """Spend energy and heat up for `dt` [s] of such torques [N m] and speeds [rad/s]; the events of it."""
        load = np.square(torques / self._efforts)
        power = IDLE_POWER + LOSS * float(load.sum()) + float(np.abs(torques * speeds).sum())
        given = IDLE_POWER + CHARGING_POWER if self.plugged else 0.0
        self._energy = min(max(0.0, self._energy + (given - power) * dt), CAPACITY)
        self.temperatures += (AMBIENT + RISE * load - self.temperatures) * (dt / TIME_CONSTANT)
        return [*self._battery(now), *self._motors(now)]

    def _battery(self, now: float) -> list[Event]:
        self._low = self._low and self.percentage < RECHARGED
        self._full = self._full and self.percentage > USED
        if not self._full and self._energy >= CAPACITY:
            self._full = True
            return [Event("battery.full", {"percentage": 100}, now)]
        if self._low or self.percentage > LOW:
            return []
        self._low = True
        return [Event("battery.low", {"percentage": self.percentage}, now)]

    def _motors(self, now: float) -> list[Event]:
        self._hot = {i for i in self._hot if self.temperatures[i] > COOLED}
        newly = [int(i) for i in np.flatnonzero(self.temperatures >= HOT) if i not in self._hot]
        self._hot.update(newly)
        return [
            Event("motors.hot", {"joint": self._names[i], "temperature": round(float(self.temperatures[i]), 1)}, now)
            for i in newly
        ]
