"""A separate channel for requests: the broker's refusal closes this channel and affects nothing else."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol


class AskedConnection(Protocol):
    """The connection of an `AskedChannel`, which waits for a condition or a time [s] and opens more channels."""

    def until(self, done: Callable[[], object]) -> None: ...

    def pause(self, seconds: float) -> None: ...

    def asking(self) -> "AbstractContextManager[AskedChannel]": ...


class AskedChannel:
    """Calls methods of pika's channel, waits for the broker's answer and returns it.

    Raises ChannelClosedByBroker if the broker refuses, and the errors of the connection's `until`.
    """

    def __init__(self, connection: AskedConnection, channel: Any) -> None:
        self.connection, self._channel = connection, channel
        self._closed: list[BaseException] = []
        channel.add_on_close_callback(lambda _, reason: self._closed.append(reason))

    def __getattr__(self, name: str) -> Callable[..., Any]:
        return lambda *args, **kwargs: self._request(getattr(self._channel, name), *args, **kwargs)

    def send(self, exchange: str, key: str, properties: Any) -> None:
        """Send an empty message; if the broker refuses it, the next request raises ChannelClosedByBroker."""
        self._channel.basic_publish(exchange, key, b"", properties)

    def close(self) -> None:
        """Close the channel without waiting for the broker's answer."""
        if self._channel.is_open:
            self._channel.close()

    def _request(self, method: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        answers: list[Any] = []
        method(*args, callback=answers.append, **kwargs)
        self.connection.until(lambda: answers or self._closed)
        if not answers:
            raise self._closed[0]
        return answers[0]
