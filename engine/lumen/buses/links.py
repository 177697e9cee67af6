"""A connection to the broker that belongs to one thread, and comes back when it is lost."""

import logging
import random
import threading
import time
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

import pika
from pika.exceptions import AMQPChannelError, AMQPError, ChannelClosedByBroker

from lumen.buses.addresses import Address

FIRST_DELAY = 0.2
LONGEST_DELAY = 10.0
STEADY = 5.0

_log = logging.getLogger(__name__)


class Link:
    """Opens, serves and reopens; a subclass says what there is to do (`begin`, `serve`, `finish`).

    All of pika happens on the link's own thread. A first failure is raised by `open`; later ones are logged, and the
    link tries again, waiting twice as long each time, up to 10 s, and at random between half and all of that.
    """

    def __init__(self, address: Address, name: str) -> None:
        self.address = address
        self.connection: Any = None
        self.channel: Any = None
        self.ending = threading.Event()
        self._opened: Future[None] = Future()
        self._thread = threading.Thread(target=self._run, name=f"lumen-bus-{name}", daemon=True)
        self._delay = FIRST_DELAY

    def open(self) -> None:
        """Connect; raises BusError with what to do where that fails."""
        self._thread.start()
        try:
            self._opened.result()
        except Exception as error:
            raise self.address.explain(error) from error

    def join(self, timeout: float) -> bool:
        """Wait until the thread has ended; whether it has, within `timeout` [s]."""
        if self._thread.ident is not None:
            self._thread.join(max(0.0, timeout))
        return not self._thread.is_alive()

    def begin(self) -> None:
        """The channel is open: make on the broker what is needed."""

    def serve(self) -> bool:
        """Do what there is to do, at most for a second; false when all is done and the link may end."""
        raise NotImplementedError

    def process(self, seconds: float) -> None:
        """Let the connection live: heartbeats, deliveries, and whatever the broker has against us, as its exception.

        pika tells nobody that the broker closed a channel, unless the channel is used; what it knows, it keeps.
        """
        self.connection.process_data_events(seconds)
        if self.channel.is_closed:
            raise getattr(self.channel, "_closing_reason", None) or AMQPChannelError("the channel is closed")

    def _run(self) -> None:
        while not self.ending.is_set():
            try:
                self.connection = pika.BlockingConnection(self.address.parameters)
            except Exception as error:
                if not self._opened.done():
                    self._opened.set_exception(error)
                    return
                self._pause(error)
            else:
                self._live()

    def _live(self) -> None:
        since = time.monotonic()
        try:
            self.channel = self.connection.channel()
            self.begin()
            self._report_open()
            while self.serve():
                pass
            self.channel.close()
        except (AMQPError, OSError) as error:
            self._lost(error, since)
        except Exception as error:
            _log.exception("the bus met something unexpected")
            if not self._opened.done():
                self._opened.set_exception(error)
            self._lost(error, since)
        finally:
            connection, self.connection, self.channel = self.connection, None, None
            with suppress(AMQPError, OSError):
                connection.close()

    def _report_open(self) -> None:
        if self._opened.done():
            _log.warning("the broker at %s is back", self.address)
        else:
            self._opened.set_result(None)

    def _lost(self, error: Exception, since: float) -> None:
        if not self._opened.done():
            self._opened.set_exception(error)
            self.ending.set()
            return
        if time.monotonic() - since > STEADY:
            self._delay = FIRST_DELAY
        if not self.ending.is_set():
            what = "refuses" if isinstance(error, ChannelClosedByBroker) else "is lost"
            _log.warning("the broker at %s %s: %r", self.address, what, error)
            self._pause(None)

    def _pause(self, error: Exception | None) -> None:
        if error:
            _log.warning("the broker at %s can't be reached: %r", self.address, error)
        self.ending.wait(self._delay * random.uniform(0.5, 1.0))
        self._delay = min(2 * self._delay, LONGEST_DELAY)
