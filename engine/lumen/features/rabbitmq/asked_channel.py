"""A channel of its own for questions: what the broker refuses closes it, and costs nothing else."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol


class AskedConnection(Protocol):
    """What a channel needs of its connection: to turn until that is so, or for so long [s]; and more channels."""

    def until(self, done: Callable[[], object]) -> None: ...

    def rest(self, seconds: float) -> None: ...

    def asking(self) -> "AbstractContextManager[AskedChannel]": ...


class AskedChannel:
    """Calls methods of pika's channel and waits for the broker's answer, which they return.

    Raises ChannelClosedByBroker where the broker refuses, and what `until` raises.
    """

    def __init__(self, connection: AskedConnection, channel: Any) -> None:
        self.connection, self._channel = connection, channel
        self._closed: list[BaseException] = []
        channel.add_on_close_callback(lambda _, reason: self._closed.append(reason))

    def __getattr__(self, name: str) -> Callable[..., Any]:
        return lambda *args, **kwargs: self._ask(getattr(self._channel, name), *args, **kwargs)

    def send(self, exchange: str, key: str, properties: Any) -> None:
        """Send an empty message; if the broker refuses it, the next question raises."""
        self._channel.basic_publish(exchange, key, b"", properties)

    def close(self) -> None:
        """Nothing more is asked; nobody waits for the broker to know."""
        if self._channel.is_open:
            self._channel.close()

    def _ask(self, method: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        answers: list[Any] = []
        method(*args, callback=answers.append, **kwargs)
        self.connection.until(lambda: answers or self._closed)
        if not answers:
            raise self._closed[0]
        return answers[0]
