"""Detects other programs that move Reachy Mini, and the direction of speech, by polling its daemon.

Programs that stream targets, as Lumen does, are detected from measured poses.
"""

import logging
from collections import deque
from collections.abc import Mapping
from math import pi, radians
from threading import Event

from lumen.errors import RobotError
from lumen.features.reachy.daemon_api import DaemonApi
from lumen.features.reachy.pose import distance
from lumen.upkeep.threads import WatchedThread

LOOK_PERIOD = 0.4
"""The period with which Lumen polls the daemon for its moves [s]."""
STRAY_ANGLE, STRAY_PLACE = radians(14), 0.014
"""Something else moves the head if it is farther than this from all targets of the last LATELY seconds [rad], [m]."""
LATELY = 0.5
"""The age up to which a target can explain the position of the head [s]."""
STRAYS, STRAY_TIME = 6, 1.0
"""The number of stray measurements, and the time [s] within which they show that something else moves the head."""
STILL_ANGLE, STILL_PLACE, STILL_TIME = radians(1.5), 0.002, 2.0
"""Nothing else moves the head any more if it moved by less than this [rad], [m] for STILL_TIME [s]."""

_log = logging.getLogger(__name__)


class DaemonMoves:
    """The moves that the daemon runs, and the directions of speech that it measured; a thread polls them.

    `ours` are the ids of the moves that Lumen began. `app` is the name of the app that has locked the robot, else
    empty.
    """

    def __init__(self, api: DaemonApi) -> None:
        self._api = api
        self.ours: set[str] = set()
        self._running: frozenset[str] = frozenset()
        self.app = ""
        self._sounds: deque[float] = deque(maxlen=3)
        self._ending = Event()
        self._thread = WatchedThread("lumen-reachy-moves", self._look)

    def start(self) -> None:
        self._thread.start()

    @property
    def foreign(self) -> bool:
        """Whether the daemon runs a move that Lumen did not begin."""
        return not self._running <= self.ours

    def sounds(self) -> list[float]:
        """Return the last directions of speech since the last call, at most 3: angles to the left of the head [rad]."""
        return [self._sounds.popleft() for _ in range(len(self._sounds))]

    def now(self) -> list[str]:
        """Return the ids of the moves that the daemon plays now. Raises RobotError if it does not answer."""
        running = self._api.request("GET", "/api/move/running", patience=2.0)
        return [str(move.get("uuid")) for move in running if isinstance(move, dict)]

    def close(self) -> None:
        self._ending.set()
        if self._thread.started:
            self._thread.join(2.0)

    def _look(self) -> None:
        while not self._ending.wait(LOOK_PERIOD):
            try:
                running = self.now()
                lock = self._api.request("GET", "/api/daemon/robot-app-lock-status", patience=2.0)
                sound = self._api.request("GET", "/api/state/doa", patience=2.0)
            except RobotError:
                self._running = frozenset()  # the link reports that the daemon is gone
                continue
            self._running = frozenset(running)
            if isinstance(sound, dict) and sound.get("speech_detected"):
                self._sounds.append(pi / 2 - float(sound.get("angle", pi / 2)))  # the daemon's 0 is left, pi is right
            self.app = str(lock.get("holder_name") or "") if isinstance(lock, dict) else ""


class Strays:
    """Detects from measured positions whether another program, or a hand, moves the head."""

    def __init__(self) -> None:
        self._sent: deque[tuple[float, Mapping[str, float]]] = deque()
        self._strange: deque[float] = deque(maxlen=STRAYS)
        self._still: tuple[float, Mapping[str, float]] | None = None
        self.taken = False

    def sent(self, joints: Mapping[str, float], now: float) -> None:
        """Record the target that Lumen sends at `now` [s]."""
        self._sent.append((now, joints))
        while len(self._sent) > 1 and self._sent[1][0] < now - LATELY:
            self._sent.popleft()

    def forget(self) -> None:
        """Drop all targets and measurements, and set `taken` to False."""
        self._sent.clear()
        self._strange.clear()
        self._still, self.taken = None, False

    def measured(self, joints: Mapping[str, float], now: float) -> None:
        """Process a measurement at `now` [s]; update `taken`, which is whether something else moves the head."""
        if self.taken:
            self._wait_for_stillness(joints, now)
        elif self._sent and all(_far(joints, sent, STRAY_ANGLE, STRAY_PLACE) for _, sent in self._sent):
            self._strange.append(now)
            if len(self._strange) == STRAYS and now - self._strange[0] <= STRAY_TIME:
                self.taken, self._still = True, (now, joints)

    def _wait_for_stillness(self, joints: Mapping[str, float], now: float) -> None:
        if self._still is None or _far(joints, self._still[1], STILL_ANGLE, STILL_PLACE):
            self._still = now, joints
        elif now - self._still[0] >= STILL_TIME:
            self.forget()


def _far(joints: Mapping[str, float], others: Mapping[str, float], angle: float, place: float) -> bool:
    angles, places = distance(joints, others)
    return angles > angle or places > place
