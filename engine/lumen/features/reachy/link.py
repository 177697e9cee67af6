"""The WebSocket to Reachy Mini's daemon: it sends targets, receives measured joints, and reconnects if it breaks."""

import json
import logging
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from threading import Condition, Event
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import RobotError, RobotLostError, RobotUnreachableError
from lumen.extras import demand
from lumen.features.reachy.daemon_api import DaemonAddress
from lumen.features.reachy.pose import JOINTS, head_joints, motor_joints
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

SILENCE = 1.0
"""The time without joints after which the robot is lost [s]: usually 40 to 50 arrive a second, none after a restart."""
SECOND_LOOK = 0.25
"""The least time that Lumen waits for a message [s], even after SILENCE, because this process may have been busy."""
OPEN_PATIENCE = 5.0
FIRST_RETRY_DELAY, MAX_RETRY_DELAY = 0.5, 5.0
"""The first and the longest wait before an attempt to reconnect [s]; the wait doubles each time."""

_log = logging.getLogger(__name__)


class LinkChange(NamedTuple):
    """A loss or a return of the connection."""

    name: str
    """`robot.lost` or `robot.back`."""
    seconds: float
    """The time for which the robot was away [s]; 0 for `robot.lost`."""
    reason: str
    """The reason why the robot is lost; empty if it is back."""


class Measured(NamedTuple):
    """The daemon's last measurement of the joints."""

    joints: Mapping[str, float]
    """The positions of all joints [rad, m]; empty before the first measurement."""
    at: float
    """The time of the measurement on the clock of `time.monotonic` [s]."""


NOTHING_MEASURED = Measured({}, 0.0)


class ReachyLink:
    """Keeps the WebSocket open; `take_over(again)` prepares the robot before each connection, on the same thread.

    `again` is False for the first connection.
    """

    def __init__(self, address: DaemonAddress, take_over: Callable[[bool], None]) -> None:
        self._address, self._take_over = address, take_over
        self._socket: ClientConnection | None = None
        self._open = ExitStack()
        self.measured = NOTHING_MEASURED
        self.up = False
        self._found: dict[str, float] = {}
        self._changes: deque[LinkChange] = deque(maxlen=100)
        self._ending = Event()
        self._target: Mapping[str, Any] | None = None
        self._wanted = Condition()
        self._keeper = WatchedThread("lumen-reachy", self._keep)
        self._sender = WatchedThread("lumen-reachy-targets", self._send_targets)

    def open(self) -> None:
        """Connect for the first time. Raises RobotError if that fails, MissingExtraError if `websockets` is missing."""
        demand("reachy", "a Reachy Mini", "websockets")
        try:
            self._connect(again=False)
        except RobotError:
            self.close()
            raise
        self._keeper.start()
        self._sender.start()

    def send(self, target: Mapping[str, Any]) -> None:
        """Queue a target, in place of one that has not been sent yet."""
        with self._wanted:
            self._target = target
            self._wanted.notify()

    def keep_still(self) -> None:
        """Drop the target if it has not been sent yet."""
        with self._wanted:
            self._target = None

    def changes(self) -> list[LinkChange]:
        """Return the changes of the connection since the last call, the oldest first."""
        return [self._changes.popleft() for _ in range(len(self._changes))]

    def close(self) -> None:
        self._ending.set()
        with self._wanted:
            self._wanted.notify_all()
        self._open.close()
        for thread in (self._keeper, self._sender):
            if thread.started:
                thread.join(2.0)

    def _connect(self, *, again: bool) -> None:
        from websockets.exceptions import InvalidHandshake
        from websockets.sync.client import connect

        self._take_over(again)
        try:
            opened = connect(
                f"ws://{self._address.authority}/ws/sdk",
                open_timeout=OPEN_PATIENCE,
                close_timeout=0.5,
                ping_interval=None,
                compression=None,
                proxy=None,
            )
            self._socket = self._open.enter_context(opened)
        except InvalidHandshake as error:
            raise RobotUnreachableError(f"what answers at {self._address} is no daemon of a Reachy Mini") from error
        except Exception as error:  # if the peer speaks first, websockets raises an AssertionError
            raise RobotLostError(f"the daemon at {self._address} does not answer: {error}") from error
        self._found.clear()
        self.measured = NOTHING_MEASURED
        begin = time.monotonic()
        while not self.measured.joints:
            self._receive(begin + OPEN_PATIENCE)
        self.keep_still()
        self.up = True

    def _keep(self) -> None:
        """Receive messages until the end, and reconnect whenever the connection breaks."""
        while not self._ending.is_set():
            try:
                while not self._ending.is_set():
                    self._receive(self.measured.at + SILENCE)
            except RobotError as error:
                self._lose(str(error))
            lost_at, backoff = time.monotonic(), Backoff(FIRST_RETRY_DELAY, MAX_RETRY_DELAY)
            while not self.up and not self._ending.wait(backoff.next()):
                self._try_again(lost_at)

    def _lose(self, reason: str) -> None:
        self.up = False
        self.keep_still()
        if self._ending.is_set():
            return
        self._changes.append(LinkChange("robot.lost", 0.0, reason))
        _log.warning("the connection to the robot is lost: %s; Lumen tries to reach it again", reason)
        self._open.close()

    def _try_again(self, lost_at: float) -> None:
        try:
            self._connect(again=True)
        except RobotError as error:
            self._open.close()
            _log.info("the robot is still unreachable: %s", error)
            return
        away = time.monotonic() - lost_at
        self._changes.append(LinkChange("robot.back", away, ""))
        _log.warning("the robot is back, after %.0f s", away)

    def _receive(self, until: float) -> None:
        """Process the next message.

        Raises RobotLostError if none came by `until`, if it is unreadable, or if the connection broke.
        """
        from websockets.exceptions import ConnectionClosed

        assert self._socket
        try:
            text = self._socket.recv(timeout=max(until - time.monotonic(), SECOND_LOOK))
        except TimeoutError:
            raise RobotLostError("its daemon sends nothing any more") from None
        except (ConnectionClosed, OSError) as error:
            raise RobotLostError("its daemon closed the connection") from error
        try:
            message = json.loads(text)
            match message["type"]:
                case "head_pose":
                    self._found |= head_joints(message["head_pose"])
                case "joint_positions":
                    self._found |= motor_joints(message)
                case _:
                    return
        except (ValueError, TypeError, KeyError, IndexError) as error:
            raise RobotLostError(f"its daemon sent a message that Lumen can't read: {error}") from error
        if len(self._found) == len(JOINTS):
            self.measured = Measured(dict(self._found), time.monotonic())

    def _send_targets(self) -> None:
        from websockets.exceptions import ConnectionClosed

        while not self._ending.is_set():
            with self._wanted:
                self._wanted.wait_for(lambda: self._target is not None or self._ending.is_set())
                target, self._target = self._target, None
            if target is None or not self.up or self._socket is None:
                continue
            try:
                self._socket.send(json.dumps(target))
            except (ConnectionClosed, OSError):
                _log.debug("a target was not sent: the connection is closed")  # the receiving thread reports that
