"""Events that NAOqi raises, and alerts for a low battery and hot motors."""

import logging
from collections import deque
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from lumen.errors import RobotFailedError
from lumen.features.naoqi.session import NaoqiSession
from lumen.language.events import Event
from lumen.ports import Tactile

FALLEN = "robotHasFallen"
FALLING = ("robotIsFalling", "ALMotion/RobotIsFalling")
"""The names in NAOqi 2.1 and 2.8 for the event at the beginning of a fall."""

SOUND = "ALSoundLocalization/SoundLocated"
SURE_SOUND = 0.5
"""The minimum confidence, from 0 to 1, at which a sound's direction is accepted."""

FULL = "BatteryFullChargedFlagChanged"

BATTERY_LOW, BATTERY_RECOVERED = 20, 25
"""The charges [%] at or below which `battery.low` is raised, and from which it can be raised again."""
MOTOR_HOT, MOTOR_COOLED = 75.0, 70.0
"""The temperatures [degrees Celsius] from which `motors.hot` is raised, and up to which it can be raised again."""

EVENT_SETTLE_TIME = 0.3
"""The time after an event from which a sensor's reading overrides that event [s]."""

_log = logging.getLogger(__name__)


def event_of(sensor: str) -> str:
    """Return ALMemory's event name for a tactile sensor."""
    return f"{sensor}{'Pressed' if sensor.endswith(('Bumper', 'Button')) else 'Touched'}"


class NaoqiEvents:
    """Receives touches, falls, sounds and a full battery on qi's threads, and returns them to the robot's thread.

    `pressed` has the state of every tactile sensor; `heard` counts the received events.
    """

    def __init__(self, sensors: Iterable[str]) -> None:
        self.pressed = dict.fromkeys(sensors, False)
        self.heard = 0
        self._since = dict.fromkeys(self.pressed, 0.0)
        self._received: deque[tuple[str, bool]] = deque(maxlen=1_000)
        self._sounds: deque[tuple[float, float]] = deque(maxlen=1)
        self._kept: list[Any] = []

    def listen(self, session: NaoqiSession) -> None:
        """Subscribe to all events in a new session; failures are logged.

        Raises RobotLostError if the connection breaks.
        """
        self._kept = []
        for name in (*self.pressed, FALLEN, *FALLING, FULL):
            event = event_of(name) if name in self.pressed else name
            try:
                self._kept.append(session.subscribe(event, partial(self._hear, name)))
            except RobotFailedError as error:
                _log.warning("the robot does not raise `%s`: %s", event, error)

        if session.has("ALSoundLocalization"):
            session.post("ALSoundLocalization", "subscribe", "lumen")
            try:
                self._kept.append(session.subscribe(SOUND, self._locate))
            except RobotFailedError as error:
                _log.warning("the robot does not look towards sounds: %s", error)

    def sounds(self) -> list[tuple[float, float]]:
        """Return the newest sound's direction and forget it; empty if no sound is new.

        The direction is two angles [rad], to the left of and below the head's direction.
        """
        found = list(self._sounds)
        self._sounds.clear()
        return found

    def take(self, now: float, felt: Tactile | None) -> list[tuple[str, bool]]:
        """Return the changes of sensors, falls and the battery up to `now` [s], each as a name and its new value.

        A sensor's events may arrive in the wrong order; newer readings in `felt` correct the sensor's state.
        """
        if felt:
            for name, value in zip(felt.names, felt.values, strict=True):
                if felt.time > self._since[name] + EVENT_SETTLE_TIME and self.pressed[name] != bool(value):
                    self._received.append((name, bool(value)))
        changed = []
        while self._received:
            name, value = self._received.popleft()
            if name not in self.pressed or self.pressed[name] != value:
                if name in self.pressed:
                    self.pressed[name], self._since[name] = value, now
                changed.append((name, value))
        return changed

    def _locate(self, value: Any) -> None:
        """Process `[[s, us], [azimuth, elevation, confidence, energy], head's place, …]`, with angles from the head."""
        try:
            azimuth, elevation, confidence = map(float, value[1][:3])
        except (TypeError, ValueError, IndexError, KeyError):
            azimuth = elevation = confidence = 0.0
        if confidence >= SURE_SOUND:
            self._sounds.append((azimuth, -elevation))
        self.heard += 1

    def _hear(self, name: str, value: Any) -> None:
        self._received.append((name, bool(value)))
        self.heard += 1


class HealthAlerts:
    """Returns the events `battery.low` and `motors.hot`.

    Each event is returned again only after the battery or the motor has recovered.
    """

    def __init__(self) -> None:
        self._low = False
        self._hot: set[str] = set()

    def battery(self, percentage: int, now: float) -> list[Event]:
        """Return `battery.low` if the charge `percentage` [%] has become low at `now` [s], else an empty list."""
        self._low = self._low and percentage < BATTERY_RECOVERED
        if self._low or percentage > BATTERY_LOW:
            return []
        self._low = True
        return [Event("battery.low", {"percentage": percentage}, now)]

    def motors(self, temperatures: Mapping[str, float], now: float) -> list[Event]:
        """Return an event for each motor that has become hot at `now` [s]."""
        self._hot = {joint for joint in self._hot if temperatures.get(joint, MOTOR_HOT) > MOTOR_COOLED}
        newly = [j for j, t in temperatures.items() if t >= MOTOR_HOT and j not in self._hot]
        self._hot.update(newly)
        return [Event("motors.hot", {"joint": j, "temperature": round(temperatures[j], 1)}, now) for j in newly]
