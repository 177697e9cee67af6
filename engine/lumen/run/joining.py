"""A program that joins an exhibition as a module: it reaches the bus and sends signs of life."""

import os
import platform
import queue
import signal
import threading
import time
import uuid
from contextlib import suppress
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any, Self

from lumen.bus.addresses import open_bus
from lumen.errors import BusError, BusUnreachableError, UsageError
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, MessageHandler
from lumen.project.main_file import main_settings
from lumen.run.parts.own_module import BUS_VARIABLE, MODULE_VARIABLE, PROJECT_VARIABLE, ROBOT_VARIABLE
from lumen.run.presence import HERE, LEAVES, PRESENCE_PERIOD, PRESENCE_ROUTE, PRESENCE_TTL
from lumen.run.reaching import reach_exhibition
from lumen.upkeep.arguments import need_text

REACH_TIMEOUT = 30.0
"""The longest wait until the bus of an exhibition can be reached [s]."""
REACH_PAUSE = 0.2
"""The pause between two attempts [s]."""


class JoinedModule:
    """A program that takes part in an exhibition under a name; `join` makes it.

    `bus` is the exhibition's bus, and `robot` the name of its robot. Use it in a `with` statement, or call `close`. If
    it is made on the main thread, it handles SIGTERM, which then ends `wait` and not the program.
    """

    def __init__(self, name: str, robot: str, bus: Bus, project: Path | None) -> None:
        self.name, self.robot, self.bus = name, robot, bus
        settings = main_settings(project, robot) if project else None
        self._routes = settings.routes if settings else {}
        self._session, self._next = uuid.uuid4().hex[:12], 0.0
        self._ending: queue.SimpleQueue[None] = queue.SimpleQueue()  # unlike an Event, safe in a signal handler
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, self._end)

    def key(self, route: str) -> str:
        """Return the routing key of a route of the project, or of one that comes with Lumen."""
        row = self._routes.get(route)
        return row.key_for(self.robot) if row else default_key(route, self.robot)

    def publish(self, route: str, body: Any) -> None:
        """Send a body on a route. Raises BusError if the bus is gone or refuses the body."""
        self.bus.publish(self.key(route), body)

    def subscribe(self, route: str, handler: MessageHandler) -> None:
        """Call `handler` with each message on a route, on the thread of the bus. Raises BusError if the bus refuses."""
        self.bus.subscribe(self.key(route), handler)

    def alive(self) -> None:
        """Send a sign of life, at most one per period; `wait` does it too. Raises BusError if the bus is gone."""
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + PRESENCE_PERIOD
            self._say(HERE)

    def wait(self, seconds: float) -> bool:
        """Wait for `seconds` [s], sending signs of life; return True after that time.

        Return False as soon as the exhibition ends this program, or the bus is gone.
        """
        until = time.monotonic() + seconds
        while self._ending.empty():
            try:
                self.alive()
            except BusError:
                return False
            left = until - time.monotonic()
            if left <= 0:
                return True
            with suppress(queue.Empty):
                self._ending.put(self._ending.get(timeout=min(left, PRESENCE_PERIOD)))
        return False

    def close(self) -> None:
        """Announce that the program leaves, and disconnect; calling it again does no harm."""
        self._ending.put(None)
        with suppress(BusError):
            self._say(LEAVES)
        self.bus.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def _end(self, number: int, frame: FrameType | None) -> None:
        self._ending.put(None)

    def _say(self, state: str) -> None:
        body = {
            "robot": self.robot,
            "parts": [self.name],
            "session": self._session,
            "state": state,
            "host": platform.node(),
            "process": os.getpid(),
        }
        self.bus.publish(self.key(PRESENCE_ROUTE), body, ttl=PRESENCE_TTL)


def join(name: str = "", *, robot: str = "", bus: str = "", project: str = "") -> JoinedModule:
    """Join a running exhibition as the module `name` of lumen.yaml.

    A program that `lumen run` starts needs no arguments. A program elsewhere passes its name, the name of the robot,
    and the address of the bus; on the exhibition's machine the project's folder can replace the address. Raises
    UsageError if the name is missing, BusError if the bus can't be reached (without an address: within 30 s).
    """
    name = name or os.environ.get(MODULE_VARIABLE, "")
    if not name:
        raise UsageError('a module needs its name in lumen.yaml: write `join("mood")`')
    need_text(name, "the name of a module")
    bus, project = bus or os.environ.get(BUS_VARIABLE, ""), project or os.environ.get(PROJECT_VARIABLE, "")
    robot = robot or os.environ.get(ROBOT_VARIABLE, "")
    folder = Path(project) if project else None
    if bus:
        settings = None if robot or folder is None else main_settings(folder)
        return JoinedModule(name, robot or (settings.robot if settings else "NAO"), open_bus(bus, name), folder)
    until = time.monotonic() + REACH_TIMEOUT
    while True:
        try:
            reached = reach_exhibition(project or None, None, robot)
        except BusUnreachableError:
            if time.monotonic() > until:
                raise
            time.sleep(REACH_PAUSE)
        else:
            return JoinedModule(name, robot or reached.robot, reached.bus, folder)
