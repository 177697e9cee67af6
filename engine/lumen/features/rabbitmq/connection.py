"""A connection to the broker that belongs to one thread and reconnects when it is lost."""

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
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

MIN_RECONNECT_DELAY = 0.2
"""The wait before the first attempt to reconnect [s]; it doubles with each further attempt."""
MAX_RECONNECT_DELAY = 10.0
"""The longest wait before an attempt to reconnect [s]."""
STABLE_TIME = 5.0
"""The lifetime of a connection above which its loss resets the wait to MIN_RECONNECT_DELAY [s]."""

_log = logging.getLogger(__name__)


class OutageLog:
    """Tracks and logs the state of one broker for all connections of a bus.

    In each outage, the recovery and the first failure of each kind are logged as warnings, repeated failures at level
    INFO.
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
        """Whether at least one connection is lost."""
        return bool(self._away)

    @property
    def blocked(self) -> str:
        """The resource that the broker lacks while it accepts no messages; empty if it accepts them."""
        return next(iter(self._blocked.copy().values()), "")

    def block(self, connection: str, what: str) -> None:
        """Record that the broker lacks `what` and blocks this connection; an empty `what` ends the block."""
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
        """Record a lost connection, and log the error; `what` describes the kind of failure."""
        with self._changing:
            self._blocked.pop(connection, None)
            new = not self._away or what not in self._logged
            self._away.add(connection)
            self._logged.add(what)
        _log.log(logging.WARNING if new else logging.INFO, "the broker at %s %s: %r", self._address, what, error)

    def warn_once(self, what: str) -> None:
        """Log a fault of the broker only once for all connections."""
        with self._changing:
            new = what not in self._faults
            self._faults.add(what)
        if new:
            _log.warning("the broker at %s: %s", self._address, what)

    def back(self, connection: str) -> None:
        """Record that a connection is back; if no other connection is lost, log that the broker is back."""
        with self._changing:
            was = connection in self._away
            self._away.discard(connection)
            over = was and not self._away
            if over:
                self._logged.clear()
        if over:
            _log.warning("the broker at %s is back", self._address)


class BrokerConnection:
    """Connects, serves and reconnects; a subclass defines its work in `begin` and `serve`.

    pika's callbacks run only on the connection's own thread. `open` raises the first failure; later failures are
    logged. The wait before reconnecting doubles each time, up to 10 s, and is shortened at random by up to half.
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
        """Connect. Raises BusError, with the remedy, if that fails."""
        self._thread.start()
        try:
            self._opened.result()
        except Exception as error:
            raise self.address.explain(error) from error

    def begin_alone(self) -> None:
        """Start connecting without waiting; each failure is logged, and connecting is retried."""
        self._opened.set_result(None)
        self._thread.start()

    def join(self, timeout: float) -> bool:
        """Wait for the thread to end; return whether it did within `timeout` [s]."""
        return self._thread.join(max(0.0, timeout))

    def begin(self) -> None:
        """Prepare the broker, for example declare queues; called whenever a channel has opened."""

    def serve(self) -> bool:
        """Do pending work for at most 1 s; return False if the connection can end."""
        raise NotImplementedError

    def process(self, seconds: float) -> None:
        """Process the connection's events for at most `seconds`, then run the work from other threads."""
        self.connection.turn(seconds)
        self.connection.work()

    def disconnect(self, connection: PolledConnection) -> None:
        """Close the connection properly, if it is still alive."""
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
        except Exception as error:
            if self._opened.done() and not isinstance(error, (AMQPError, OSError)):
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
