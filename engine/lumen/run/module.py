"""The base class of modules: it handles messages on a thread of its own, and reports failures to the operator."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Self

from lumen.errors import BusError, ModuleError
from lumen.language.modules import ModuleSettings
from lumen.language.projects import Project
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, Message, MessageHandler
from lumen.project.broken_features import fault_of_package
from lumen.upkeep.drops import DropLog
from lumen.upkeep.threads import WatchedThread

MAX_WAITING_MESSAGES = 1_000
"""The number of messages that may wait for a module; one more drops the oldest."""
MAX_REASONS = 50
"""The number of different troubles that are reported until the module works again."""
KEEP_DAYS = 30.0
"""The default time for which a module keeps data about people [days]."""
DAY = 86_400.0
"""The length of a day [s]."""

_log = logging.getLogger(__name__)


class Module:
    """A handler of the messages on the routes of `hears`, one at a time, in order, on its own thread.

    If a handler raises an error, its message is lost. Each reason is then reported once until the module works again:
    to `tell`, and on the route `trouble` for operators of other processes. Of a route that keeps one message, only the
    newest waits. Subclasses set `name` and override `hears`; call `begin` to start the module.
    """

    name = ""

    def __init__(
        self, project: Project, bus: Bus, tell: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.project, self.bus, self.clock = project, bus, clock
        self.handled = 0
        """The number of messages handled so far."""
        self.came = 0.0
        """When the message being handled arrived, by `clock` [s]."""
        self._tell = tell
        self._waiting: deque[tuple[str, Message, float]] = deque(maxlen=MAX_WAITING_MESSAGES)
        self._drops = DropLog(_log)
        self._changed = threading.Condition()
        self._busy = self._ending = False
        self._told: set[str] = set()
        self._undo: list[Callable[[], None]] = []
        self._thread = WatchedThread(f"lumen-{self.name}", self._run)

    @classmethod
    def make(cls, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Self:
        """Return a module for an exhibition, not yet begun; `folder` is for its files, None if nothing may be saved.

        Raises ModuleError if a requirement of the module is missing.
        """
        return cls(project, bus, tell)

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the handlers of messages by route."""
        raise NotImplementedError

    @property
    def refused(self) -> int:
        """The number of messages that the module refused; 0 in modules that do not count them."""
        return 0

    @property
    def settings(self) -> ModuleSettings:
        """The module's settings in `lumen.yaml`."""
        return self.project.modules.get(self.name, ModuleSettings())

    def begin(self) -> None:
        """Subscribe to the module's routes, and start its thread."""
        self._listen()
        self._thread.start()

    def use(self, project: Project) -> None:
        """Switch to the routes of another project."""
        old, self.project = self._undo, project
        self._undo = []
        self._listen()
        for undo in old:
            undo()

    def settle(self, timeout: float = 5.0) -> bool:
        """Wait until everything that has arrived is handled; return False if `timeout` [s] passes first."""
        with self._changed:
            return self._changed.wait_for(lambda: not (self._waiting or self._busy), timeout)

    def close(self) -> None:
        """Handle the waiting messages, and end the thread; wait at most 5 s. Calling it again does no harm."""
        for undo in self._undo:
            undo()
        self._undo = []
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        self._thread.join(5.0)

    def publish(self, route: str, body: Any) -> None:
        """Send a body on a route; report an error of the bus to the operator."""
        row = self.project.routes.get(route)
        try:
            self.bus.publish(self.key(route), body, ttl=row.ttl if row else None)
        except BusError as error:
            self.tell(str(error))

    def reply(self, message: Message, body: Any) -> None:
        """Answer the sender of a message; report an error of the bus to the operator."""
        try:
            self.bus.reply(message, body)
        except BusError as error:
            self.tell(str(error))

    def key(self, route: str) -> str:
        """Return the routing key of a route."""
        row = self.project.routes.get(route)
        return row.key_for(self.project.robot) if row else default_key(route, self.project.robot)

    def tell(self, text: str) -> None:
        """Report a text to the operators: each text once, and at most MAX_REASONS texts, until `well` is called."""
        if text not in self._told and len(self._told) < MAX_REASONS:
            self._told.add(text)
            self._tell(text)
            try:
                self.bus.publish(self.key("trouble"), {"module": self.name, "text": text}, ttl=10.0)
            except BusError as error:
                _log.debug("an error of the module could not be published: %s", error)

    def well(self) -> None:
        """Record that the module works again, so that the same troubles are reported again."""
        self._told.clear()

    def _listen(self) -> None:
        for route in self.hears():
            self._undo.append(self.bus.subscribe(self.key(route), partial(self._take, route)))

    def _take(self, route: str, message: Message) -> None:
        row = self.project.routes.get(route)
        with self._changed:
            if row and row.keep == 1:
                self._waiting = deque((w for w in self._waiting if w[0] != route), maxlen=MAX_WAITING_MESSAGES)
            self._drops.push(
                self._waiting,
                (route, message, self.clock()),
                lambda waiting: waiting[1].key,
                f"{self.name} is too slow",
            )
            self._changed.notify_all()

    def _run(self) -> None:
        while job := self._next():
            route, message, self.came = job
            try:
                if handler := self.hears().get(route):  # else the route was unsubscribed meanwhile
                    handler(message)
            except ModuleError as error:
                self.tell(str(error))
            except BaseException as error:  # an internal error, or one of a package, loses only this message
                _log.exception("the module `%s` failed on `%s`", self.name, message.key)
                self.tell(fault_of_package(error) or f"failed on a message: {error!r}")
            self.handled += 1
        self.end()

    def end(self) -> None:
        """Close the resources of the module's thread; called on that thread when it ends."""

    def idle(self) -> float | None:
        """Do idle work; called on the module's thread when no message waits.

        Return the time until the next call [s]; None to wait for a message.
        """
        return None

    def _next(self) -> tuple[str, Message, float] | None:
        while True:
            with self._changed:
                if self._waiting:
                    self._busy = True
                    return self._waiting.popleft()
            again = self.idle()
            with self._changed:
                if self._waiting:
                    continue
                self._busy = False
                self._changed.notify_all()
                if self._ending:
                    return None
                self._changed.wait_for(lambda: self._waiting or self._ending, again)
                self._busy = True
