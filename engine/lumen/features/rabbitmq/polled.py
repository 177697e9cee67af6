"""pika's asynchronous connection, driven by the thread that owns it: our callbacks run only inside `turn`.

While that thread waits, other threads can use the connection with `lend`, without waking it.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from typing import Any

from pika.exceptions import (
    AMQPChannelError,
    AMQPConnectionError,
    AMQPError,
    ChannelWrongStateError,
    ConnectionBlockedTimeout,
)

from lumen.features.rabbitmq.asked_channel import AskedChannel
from lumen.features.rabbitmq.broker import BROKER_TIMEOUT, shortage
from lumen.features.rabbitmq.poll_loop import PollLoop
from lumen.features.rabbitmq.wire import MessageReader, WireConnection

STALL_TIME = 0.5
"""The excess over a turn's planned time above which the process counts as suspended [s]."""


class TurnClock:
    """Estimates when messages arrived, from the turns of a connection.

    A process that was suspended during one turn may read the messages of that time only in the next turn. The messages
    of both turns therefore count as arrived when the first turn began.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._begun, self._most = clock(), 0.0
        self._stood_since: float | None = None

    def begin(self, most: float) -> None:
        """Begin a turn that takes at most `most` [s]."""
        now = self._clock()
        self._stood_since = self._begun if self._stood(now) else None
        self._begun, self._most = now, most

    def arrival(self) -> float:
        """Return the earliest time at which data received now can have arrived [s, by `clock`].

        This is the present time unless the process was suspended.
        """
        now = self._clock()
        if self._stood_since is not None:
            return self._stood_since
        return self._begun if self._stood(now) else now

    def _stood(self, now: float) -> bool:
        return now - self._begun > self._most + STALL_TIME


class PolledConnection:
    """An open connection and its channel. Raises pika's exceptions if it can't be opened or is lost.

    Unlike `BlockingConnection`, it does not wait until each message is sent or confirmed. `blocked` names the resource
    that the broker lacks while it accepts no messages, and is empty otherwise. `told` is called with each new value.
    """

    def __init__(self, parameters: Any, told: Callable[[str], None] = lambda blocked: None) -> None:
        self.blocked, self._told = "", told
        self.clock = TurnClock()
        self._loop = PollLoop()
        self._used = threading.Lock()
        self._used.acquire()
        self._woken = threading.Event()
        self._error: BaseException | None = None
        self._has: Callable[[int, bool], object] = lambda number, several: None
        self._works: deque[Callable[[], None]] = deque()
        self.channel: Any = None
        self._connection: Any = None
        try:
            self._open(parameters)
        except BaseException:
            self.close()
            raise

    @property
    def server(self) -> dict[str, Any]:
        """The broker's properties, such as its product and version."""
        return self._connection.server_properties or {}

    def open_channel(self) -> Any:
        """Open a channel that replaces the last one, and return it."""
        self.channel = self._open_channel()
        self.channel.add_on_close_callback(lambda _, reason: self._closed(reason))
        return self.channel

    @contextmanager
    def asking(self) -> Iterator[AskedChannel]:
        """Open a separate channel for requests; the broker's refusal closes only that channel."""
        channel = AskedChannel(self, self._open_channel())
        try:
            yield channel
        finally:
            channel.close()

    def request(self, method: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
        """Call a method of the channel and wait for the broker's answer."""
        answers: list[Any] = []
        method(*args, callback=answers.append, **kwargs)
        self.until(lambda: answers)

    def publish(self, exchange: str, key: str, properties: bytes, body: bytes, *, mandatory: bool) -> None:
        """Buffer a message; the buffer is sent by `turn`, after `lend`, and when it is full.

        Raises ValueError if AMQP can't represent the message, ChannelWrongStateError if the channel is closed.
        """
        if not self.channel.is_open:
            raise ChannelWrongStateError("the channel is closed")
        self._connection.send(self.channel.channel_number, exchange, key, properties, body, mandatory=mandatory)

    def confirm(self, has: Callable[[int, bool], None], lacks: Callable[[int, bool], None]) -> None:
        """Request confirmations: the broker's acknowledgement calls `has`, its rejection `lacks`.

        Both receive a message's number, and whether the answer also applies to all earlier messages.
        """

        def refused(frame: Any) -> None:
            lacks(frame.method.delivery_tag, frame.method.multiple)

        self._has = has
        self.request(self.channel.confirm_delivery, refused)

    def consume(self, queue: str, reader: MessageReader, arguments: Mapping[str, Any] | None = None) -> str:
        """Start consuming a queue, wait for the broker's answer, and return the consumer's tag for `cancel`."""
        known: list[Any] = []
        tag: str = self.channel.basic_consume(queue, lambda *_: None, arguments=arguments, callback=known.append)
        self._connection.readers[tag.encode()] = reader
        self.until(lambda: known)
        return tag

    def cancel(self, tag: str) -> None:
        """Stop consuming; messages that arrive meanwhile return to the queue. Ignore unknown tags."""
        if self._connection.readers.pop(tag.encode(), None):
            self.request(self.channel.basic_cancel, tag)

    def until(self, done: Callable[[], object]) -> None:
        """Run turns until `done` is true.

        Raises TimeoutError after BROKER_TIMEOUT, and ConnectionBlockedTimeout if the broker accepts no messages.
        """
        deadline = time.monotonic() + BROKER_TIMEOUT
        while not done():
            if self.blocked:
                raise ConnectionBlockedTimeout(self.blocked)
            if time.monotonic() > deadline:
                raise TimeoutError(f"no answer within {BROKER_TIMEOUT:g} s")
            self.turn(0.5)

    def turn(self, seconds: float, pause: float = 0.0) -> None:
        """Wait for events for at most `seconds` or until `wake` is called, then process them.

        First wait up to `pause` [s] for `wake` only, while events accumulate. Raises the error of a failed connection.
        """
        self.clock.begin(pause + seconds)
        self._connection.flush()
        self._used.release()
        try:
            if pause:
                self._woken.wait(pause)
            events = self._loop.wait(seconds)
        finally:
            self._used.acquire()
        self._woken.clear()
        self._loop.call(events)
        self._connection.flush()
        if self._error:
            raise self._error

    def lend(self, work: Callable[[], bool]) -> bool:
        """Run `work` if the connection's owner is waiting, and return its result; return False if the owner is busy.

        Any thread may call this.
        """
        if not self._used.acquire(blocking=False):
            return False
        try:
            return work()
        finally:
            self._connection.flush()
            self._used.release()

    def wake(self) -> None:
        """Make `turn` return. Any thread may call this."""
        self._woken.set()
        self._loop.add_callback(lambda: None)

    def later(self, work: Callable[[], None]) -> None:
        """Let the owning thread run `work` between two turns; `work` may send requests to the broker.

        Any thread may call this.
        """
        self._works.append(work)
        self.wake()

    def work(self) -> None:
        """Run the functions passed to `later`, between two turns."""
        while self._works:
            self._works.popleft()()

    def call_later(self, seconds: float, work: Callable[[], None]) -> None:
        """Run `work` within a turn after `seconds`; `work` must not send requests to the broker."""
        self._loop.call_later(seconds, work)

    def pause(self, seconds: float) -> None:
        """Process events for `seconds`."""
        rung: list[bool] = []
        self.call_later(seconds, lambda: rung.append(True))
        self.until(lambda: rung)

    def fail(self, error: BaseException) -> None:
        """Make the current turn raise this error. Only callbacks may call this."""
        self._error = error

    def close(self) -> None:
        """Close the connection properly if possible, and its socket and the loop in any case."""
        with closing(self._loop), ExitStack() as after, suppress(AMQPError, OSError):
            if self._connection is not None:
                after.callback(self._connection.abandon)
                if self._connection.is_open:
                    self._error = None
                    self._connection.close()
                    self.until(lambda: self._connection.is_closed)

    def _open_channel(self) -> Any:
        opened: list[Any] = []
        channel = self._connection.channel(on_open_callback=opened.append)
        self.until(lambda: opened or channel.is_closed)
        return channel

    def _open(self, parameters: Any) -> None:
        opened: list[Any] = []
        self._connection = WireConnection(
            parameters,
            on_open_callback=opened.append,
            on_open_error_callback=lambda _, error: self._failed(error),
            on_close_callback=lambda _, reason: self._failed(reason),
            custom_ioloop=self._loop,
            unread=lambda number: self.channel.basic_reject(number),
            confirmed=lambda number, several: self._has(number, several),
        )
        self._connection.add_on_connection_blocked_callback(
            lambda _, frame: self._block(shortage(str(frame.method.reason)))
        )
        self._connection.add_on_connection_unblocked_callback(lambda *_: self._block(""))
        self.until(lambda: opened)

    def _block(self, what: str) -> None:
        self.blocked = what
        self._told(what)

    def _failed(self, error: BaseException | str) -> None:
        self._error = error if isinstance(error, BaseException) else AMQPConnectionError(error)

    def _closed(self, reason: BaseException) -> None:
        if self._error is None:
            self._error = reason if isinstance(reason, AMQPError) else AMQPChannelError(reason)
