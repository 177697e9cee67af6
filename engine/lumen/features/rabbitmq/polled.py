"""pika's asynchronous connection, driven by the thread that owns it: no callback of ours runs but inside `turn`.

That thread has the connection for itself but while it waits; then others may use it (`lend`), without waking it.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
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
"""By how much a turn may take longer [s] before this process counts as having stood still."""


class TurnClock:
    """Follows the turns of a connection.

    Who wakes up in the middle of a turn may see only in the next one what came in this one: both count from its begin.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._begun, self._most = clock(), 0.0
        self._stood_since: float | None = None

    def begin(self, most: float) -> None:
        """A turn begins, which takes `most` [s]."""
        now = self._clock()
        self._stood_since = self._begun if self._stood(now) else None
        self._begun, self._most = now, most

    def arrival(self) -> float:
        """When what is received now came at the earliest [s, by `clock`]: now, unless this process stood still."""
        now = self._clock()
        if self._stood_since is not None:
            return self._stood_since
        return self._begun if self._stood(now) else now

    def _stood(self, now: float) -> bool:
        return now - self._begun > self._most + STALL_TIME


class PolledConnection:
    """An open connection and its channel. Raises what pika raises, where it can't be opened or is lost.

    Unlike `BlockingConnection` it waits neither for each message to be sent nor for each confirm to come.

    `blocked` names the resource that the broker lacks while it accepts nothing, else it is empty; `told` is called
    with each change.
    """

    def __init__(self, parameters: Any, told: Callable[[str], None] = lambda blocked: None) -> None:
        self.blocked, self._told = "", told
        self.clock = TurnClock()
        self._loop = PollLoop()
        self._used = threading.Lock()
        self._used.acquire()
        self._woken = threading.Event()
        self._error: BaseException | None = None
        self._has: Callable[[int, bool], None] | None = None
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
        """What the broker says of itself."""
        return self._connection.server_properties or {}

    def open_channel(self) -> Any:
        """A channel; the one before is gone."""
        self.channel = self._open_channel()
        self.channel.add_on_close_callback(lambda _, reason: self._closed(reason))
        return self.channel

    @contextmanager
    def asking(self) -> Iterator[AskedChannel]:
        """A channel of its own for questions, which closes where the broker refuses."""
        channel = AskedChannel(self, self._open_channel())
        try:
            yield channel
        finally:
            channel.close()

    def ask(self, method: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
        """Call a method of the channel and wait for the broker's answer."""
        answers: list[Any] = []
        method(*args, callback=answers.append, **kwargs)
        self.until(lambda: answers)

    def publish(self, exchange: str, key: str, properties: bytes, body: bytes, *, mandatory: bool) -> None:
        """Send a message with the next turn; raises ValueError where AMQP can't carry it."""
        if not self.channel.is_open:
            raise ChannelWrongStateError("the channel is closed")
        self._connection.send(self.channel.channel_number, exchange, key, properties, body, mandatory=mandatory)

    def confirm(self, has: Callable[[int, bool], None], lacks: Callable[[int, bool], None]) -> None:
        """Have the broker say which of the messages sent from now on it has, by number, and by `True` all before."""

        def refused(frame: Any) -> None:
            lacks(frame.method.delivery_tag, frame.method.multiple)

        self._has = has
        self.ask(self.channel.confirm_delivery, refused)

    def consume(self, queue: str, reader: MessageReader, arguments: Mapping[str, Any] | None = None) -> str:
        """Have messages of a queue read, of which the broker knows then; the tag by which to `cancel` that."""
        known: list[Any] = []
        tag: str = self.channel.basic_consume(queue, lambda *_: None, arguments=arguments, callback=known.append)
        self._connection.readers[tag.encode()] = reader
        self.until(lambda: known)
        return tag

    def cancel(self, tag: str) -> None:
        """Read no more; what comes meanwhile goes back to the queue."""
        if self._connection.readers.pop(tag.encode(), None):
            self.ask(self.channel.basic_cancel, tag)

    def until(self, done: Callable[[], object]) -> None:
        """Turn until `done`, at most for the broker's time to answer. Raises at once if the broker accepts nothing."""
        deadline = time.monotonic() + BROKER_TIMEOUT
        while not done():
            if self.blocked:
                raise ConnectionBlockedTimeout(self.blocked)
            if time.monotonic() > deadline:
                raise TimeoutError(f"no answer within {BROKER_TIMEOUT:g} s")
            self.turn(0.5)

    def turn(self, seconds: float, pause: float = 0.0) -> None:
        """Let the connection live: at most so long, or until something happens or `wake` is called.

        Before that only `wake` is waited for, as long as `pause` [s]: what happens meanwhile is used at once.
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
        """From any thread: do this with the connection while its owner waits; what it says, or false: it is in use."""
        if not self._used.acquire(blocking=False):
            return False
        try:
            return work()
        finally:
            self._connection.flush()
            self._used.release()

    def wake(self) -> None:
        """From any thread: let `turn` return."""
        self._woken.set()
        self._loop.add_callback(lambda: None)

    def later(self, work: Callable[[], None]) -> None:
        """From any thread: have the thread that owns the connection do this in `work`, where it may ask the broker."""
        self._works.append(work)
        self.wake()

    def work(self) -> None:
        """Do what others wanted done `later`, between two turns."""
        while self._works:
            self._works.popleft()()

    def call_later(self, seconds: float, work: Callable[[], None]) -> None:
        """Do this within a turn in so many seconds; it may not ask the broker."""
        self._loop.call_later(seconds, work)

    def rest(self, seconds: float) -> None:
        """Turn for so long."""
        rung: list[bool] = []
        self.call_later(seconds, lambda: rung.append(True))
        self.until(lambda: rung)

    def fail(self, error: BaseException) -> None:
        """Within a callback: have the turn raise this."""
        self._error = error

    def close(self) -> None:
        """End in good order where it can be; the loop is gone afterwards."""
        try:
            if self._connection is not None and self._connection.is_open:
                self._error = None
                self._connection.close()
                self.until(lambda: self._connection.is_closed)
        except (AMQPError, OSError):
            pass
        finally:
            self._loop.close()

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
            confirmed=self._confirmed,
        )
        self._connection.add_on_connection_blocked_callback(
            lambda _, frame: self._block(shortage(str(frame.method.reason)))
        )
        self._connection.add_on_connection_unblocked_callback(lambda *_: self._block(""))
        self.until(lambda: opened)

    def _confirmed(self, number: int, several: bool) -> None:
        if self._has:
            self._has(number, several)

    def _block(self, what: str) -> None:
        self.blocked = what
        self._told(what)

    def _failed(self, error: BaseException | str) -> None:
        self._error = error if isinstance(error, BaseException) else AMQPConnectionError(error)

    def _closed(self, reason: BaseException) -> None:
        if self._error is None:
            self._error = reason if isinstance(reason, AMQPError) else AMQPChannelError(reason)
