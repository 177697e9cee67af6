"""pika's asynchronous connection, driven by whoever owns it: no callback of ours runs but inside `turn`."""

import time
from collections.abc import Callable
from typing import Any

import pika
from pika.adapters.select_connection import IOLoop
from pika.exceptions import AMQPChannelError, AMQPConnectionError, AMQPError, ChannelClosedByBroker

from lumen.buses.broker import BROKER_TIMEOUT
from lumen.buses.queues import ChannelCall

FLUSH_BYTES = 8 * 1024
"""From how many bytes on frames are sent at once; what is less is sent at the next turn."""


class _BufferedConnection(pika.SelectConnection):  # type: ignore[misc]  # pika is not typed
    """Frames are sent together: a message has three, and pika would call the system for each."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._frames: list[bytes] = []
        self._size = 0
        super().__init__(*args, **kwargs)

    def flush(self) -> None:
        if self._frames:
            data, self._frames, self._size = b"".join(self._frames), [], 0
            if not self.is_closed:
                super()._adapter_emit_data(data)

    def _adapter_emit_data(self, data: bytes) -> None:
        self._frames.append(data)
        self._size += len(data)
        if self._size > FLUSH_BYTES:
            self.flush()


class PolledConnection:
    """An open connection and its channel. Raises what pika raises, where it can't be opened or is lost.

    Unlike `BlockingConnection` it waits neither for each message to be sent nor for each confirm to come.
    """

    def __init__(self, parameters: Any) -> None:
        self._loop = IOLoop()
        self._loop.activate_poller()
        self._error: BaseException | None = None
        self._alarm: object = None
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
        opened: list[Any] = []
        self.channel = self._connection.channel(on_open_callback=opened.append)
        self.channel.add_on_close_callback(lambda _, reason: self._closed(reason))
        self.until(lambda: opened)
        return self.channel

    def attempt(self, work: Callable[[ChannelCall, Any], None]) -> str:
        """Do something on a channel of its own, which closes where the broker refuses; empty, or why it does."""
        opened: list[Any] = []
        closed: list[BaseException] = []
        channel = self._connection.channel(on_open_callback=opened.append)
        channel.add_on_close_callback(lambda _, reason: closed.append(reason))
        self.until(lambda: opened or closed)

        def call(method: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
            answers: list[Any] = []
            method(*args, callback=answers.append, **kwargs)
            self.until(lambda: answers or closed)
            if closed:
                raise closed[0]

        try:
            work(call, channel)
        except ChannelClosedByBroker as error:
            return str(error.reply_text)
        channel.close()
        return ""

    def ask(self, method: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
        """Call a method of the channel and wait for the broker's answer."""
        answers: list[Any] = []
        method(*args, callback=answers.append, **kwargs)
        self.until(lambda: answers)

    def until(self, done: Callable[[], object]) -> None:
        """Turn until that is so, for as long as the broker may take to answer."""
        deadline = time.monotonic() + BROKER_TIMEOUT
        while not done():
            if time.monotonic() > deadline:
                raise TimeoutError(f"no answer within {BROKER_TIMEOUT:g} s")
            self.turn(0.5)

    def turn(self, seconds: float) -> None:
        """Let the connection live: at most so long, or until something happens or `wake` is called."""
        if not seconds:
            self._loop.call_later(0.0, lambda: None)
        elif self._alarm is None:  # one for many turns: a timer that is removed would still wake it
            self._alarm = self._loop.call_later(seconds, self._rung)
        self._connection.flush()
        self._loop.poll()
        self._loop.process_timeouts()
        self._connection.flush()
        if self._error:
            raise self._error

    def _rung(self) -> None:
        self._alarm = None

    def wake(self) -> None:
        """From any thread: let `turn` return."""
        self._loop.add_callback_threadsafe(lambda: None)

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
            self._loop.deactivate_poller()
            self._loop.close()

    def _open(self, parameters: Any) -> None:
        opened: list[Any] = []
        self._connection = _BufferedConnection(
            parameters,
            on_open_callback=opened.append,
            on_open_error_callback=lambda _, error: self._failed(error),
            on_close_callback=lambda _, reason: self._failed(reason),
            custom_ioloop=self._loop,
        )
        self.until(lambda: opened)

    def _failed(self, error: BaseException | str) -> None:
        self._error = error if isinstance(error, BaseException) else AMQPConnectionError(error)

    def _closed(self, reason: BaseException) -> None:
        if self._error is None:
            self._error = reason if isinstance(reason, AMQPError) else AMQPChannelError(reason)
