"""A connection to the broker that belongs to one thread, and comes back when it is lost."""

import logging
import random
import threading
import time
from concurrent.futures import Future
from functools import partial
from typing import Any

from pika.exceptions import AMQPError, ChannelClosedByBroker

from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.upkeep.backoff import Backoff
from lumen.upkeep.threads import WatchedThread

MIN_RECONNECT_DELAY = 0.2
"""How long the first attempt to reconnect is waited for [s]; each further one twice as long."""
MAX_RECONNECT_DELAY = 10.0
"""How long an attempt to reconnect is waited for at most [s]."""
STABLE_TIME = 5.0
"""A connection that lived for so long [s] was a good one: the next loss begins with the shortest delay again."""

_log = logging.getLogger(__name__)


class OutageLog:
    """One broker as all connections of a bus see it: each loss and each return is logged once, whoever notices first.

    The `repr` of every failure is logged, those after the first of an outage, and repeated ones, at level INFO.
    """

    def __init__(self, address: BrokerAddress) -> None:
        self._address = address
        self._away: set[str] = set()
        self._logged: set[str] = set()
        self._faults: set[str] = set()
        self._blocked: dict[str, str] = {}
        self._changing = threading.Lock()

    @property
    def going_on(self) -> bool:
        """Whether any of the connections is away."""
        return bool(self._away)

    @property
    def blocked(self) -> str:
        """The resource that the broker lacks while it accepts no messages; empty while it accepts them."""
        return next(iter(self._blocked.copy().values()), "")

    def block(self, connection: str, what: str) -> None:
        """Note that the broker, short of `what`, blocks this connection; an empty `what` ends that."""
        with self._changing:
            before = bool(self._blocked)
            self._blocked.pop(connection, None)
            if what:
                self._blocked[connection] = what
            after = bool(self._blocked)
        if after and not before:
            _log.warning("%s", self._address.short_of(what))
        elif before and not after:
            _log.warning("the broker at %s accepts messages again", self._address)

    def lost(self, connection: str, what: str, error: BaseException) -> None:
        with self._changing:
            self._blocked.pop(connection, None)
            new = not self._away or what not in self._logged
            self._away.add(connection)
            self._logged.add(what)
        _log.log(logging.WARNING if new else logging.INFO, "the broker at %s %s: %r", self._address, what, error)

    def warn_once(self, what: str) -> None:
        """Log a fault of the broker once, although every connection meets it."""
        with self._changing:
            new = what not in self._faults
            self._faults.add(what)
        if new:
            _log.warning("the broker at %s: %s", self._address, what)

    def back(self, connection: str) -> None:
        with self._changing:
            was = connection in self._away
            self._away.discard(connection)
            over = was and not self._away
            if over:
                self._logged.clear()
        if over:
            _log.warning("the broker at %s is back", self._address)


class BrokerConnection:
    """Opens, serves and reopens; a subclass says what there is to do (`begin`, `serve`).

    All of pika happens on the connection's own thread. A first failure is raised by `open`; later ones are logged,
    and it is opened again, after twice as long each time, up to 10 s, and at random between half and all of that.
    """

    def __init__(self, address: BrokerAddress, name: str, outage: OutageLog) -> None:
        self.address, self.name, self._outage = address, name, outage
        self.connection: Any = None
        self.channel: Any = None
        self.ending = threading.Event()
        self._opened: Future[None] = Future()
        self._thread = WatchedThread(f"lumen-bus-{name}", self._run, vital=True)
        self._backoff = Backoff(MIN_RECONNECT_DELAY, MAX_RECONNECT_DELAY)

    def open(self) -> None:
        """Connect; raises BusError with what to do where that fails."""
        self._thread.start()
        try:
            self._opened.result()
        except Exception as error:
            raise self.address.explain(error) from error

    def begin_alone(self) -> None:
        """Connect as soon as may be; a failure is logged, and tried again."""
        self._opened.set_result(None)
        self._thread.start()

    def join(self, timeout: float) -> bool:
        """Wait until the thread has ended; whether it has, within `timeout` [s]."""
        return self._thread.join(max(0.0, timeout))

    def begin(self) -> None:
        """The channel is open: make on the broker what is needed."""

    def serve(self) -> bool:
        """Do what there is to do, at most for a second; false when all is done and the connection may end."""
        raise NotImplementedError

    def process(self, seconds: float) -> None:
        """Let the connection live for at most so long, then do what other threads want of it."""
        self.connection.turn(seconds)
        self.connection.work()

    def disconnect(self, connection: PolledConnection) -> None:
        """End the connection in good order, where it still lives."""
        connection.close()

    def _run(self) -> None:
        while not self.ending.is_set():
            try:
                self.connection = PolledConnection(self.address.parameters, partial(self._outage.block, self.name))
            except Exception as error:
                if not self._opened.done():
                    self._opened.set_exception(error)
                    return
                self._outage.lost(self.name, "cannot be reached", error)
                self._pause()
            else:
                self._live()

    def _live(self) -> None:
        since = time.monotonic()
        try:
            self.channel = self.connection.open_channel()
            self.begin()
            self._outage.back(self.name)
            if not self._opened.done():
                self._opened.set_result(None)
            while self.serve():
                pass
        except (AMQPError, OSError) as error:
            self._lost(error, since)
        except Exception as error:
            if self._opened.done():
                _log.exception("the bus failed unexpectedly")
            self._lost(error, since)
        finally:
            connection, self.connection, self.channel = self.connection, None, None
            self.disconnect(connection)

    def _lost(self, error: Exception, since: float) -> None:
        if not self._opened.done():
            self._opened.set_exception(error)
            self.ending.set()
            return
        if time.monotonic() - since > STABLE_TIME:
            self._backoff.reset()
        if not self.ending.is_set():
            what = "refuses" if isinstance(error, ChannelClosedByBroker) else "is lost"
            self._outage.lost(self.name, what, error)
            self._pause()

    def _pause(self) -> None:
        self.ending.wait(self._backoff.next() * random.uniform(0.5, 1.0))
