"""Messages, the bus that carries them, and what only some buses can do."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from itertools import count
from os import urandom
from threading import Event as Signal
from typing import Any, NamedTuple, Protocol, TypeVar, runtime_checkable

from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.language.routes import Route


class Message(NamedTuple):
    """A message as a subscriber receives it; `body` is JSON data.

    `id` tells it from every other message, `sender` is the program it comes from, empty where that is not known. `time`
    is when it was sent, as far as the sender said, else when it came [s since 1970, in UTC]. `cause` is what in a
    behaviour asked for it, as in `MessageOrigin`.
    """

    key: str
    body: Any
    reply_to: str = ""
    correlation_id: str = ""
    id: str = ""
    sender: str = ""
    time: float = 0.0
    cause: str = ""


MessageHandler = Callable[[Message], None]

Ability = TypeVar("Ability")

PREFIX, NUMBERS = urandom(5).hex(), count(1)
"""The parts of each message id: a prefix of this process, and a number."""

_new = tuple.__new__  # half the price of Outgoing(…), which each message pays


class Outgoing(NamedTuple):
    """A message as it is sent; `Bus.publish` and `MessageOrigin` describe the fields. `publish` fills in the `id`."""

    key: str
    body: Any
    reply_to: str = ""
    correlation_id: str = ""
    ttl: float | None = None
    id: str = ""
    sender: str = ""
    time: float = 0.0
    cause: str = ""


@runtime_checkable
class Bus(Protocol):
    """Messages by topic: `*` in a pattern stands for one word of the key, `#` for any number.

    A bus of your own inherits from this class and implements the methods without a body. What only some buses can do
    is a protocol of its own, such as `CountsDrops`: ask for it with `ability`.
    """

    def ability(self, kind: type[Ability]) -> Ability | None:
        """Return this bus as one with that ability; None if it lacks it. A wrapper passes the question inward."""
        return self if isinstance(self, kind) else None

    @abstractmethod
    def carry(self, routes: Mapping[str, Route]) -> None:
        """From now on, carry messages with these keys as their routes say, and all others as telemetry."""
        ...

    @abstractmethod
    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Prepare `carry`, and subscribing to the incoming routes, so that neither has to wait later.

        This may wait for the network, so call it on a background thread. Afterwards subscribing does not wait.
        Raises BusError if the broker refuses one of the routes.
        """
        ...

    @abstractmethod
    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        """Call `handler` with each matching message, one by one, in the order published; the result ends it.

        An exception in a handler is logged and ends neither the bus nor the publisher.
        """
        ...

    def publish(
        self,
        key: str,
        body: Any,
        *,
        reply_to: str = "",
        correlation_id: str = "",
        ttl: float | None = None,
        origin: MessageOrigin = UNKNOWN_ORIGIN,
    ) -> None:
        """Send a body (JSON data); safe from any thread. Raises BusError after `close`, or if it is not JSON data.

        The bus fills in what `origin` leaves empty: an id that no other message has, its own `sender`, and the time.
        """
        id, sender, time, cause = origin
        id = id or f"{PREFIX}-{next(NUMBERS)}"
        self.send(_new(Outgoing, (key, body, reply_to, correlation_id, ttl, id, sender, time, cause)))

    @abstractmethod
    def send(self, message: Outgoing) -> None:
        """Send a message as `publish` does.

        It never waits for a handler on another thread, nor for the network. A bus without its own thread (`memory://`)
        may run handlers inside `send`, if no other thread is delivering; so a handler should only enqueue.
        """
        ...

    @abstractmethod
    def reply(self, message: Message, body: Any) -> None:
        """Send an answer to the message's `reply_to`, with its `correlation_id`; does nothing without a `reply_to`.

        `reply_to` is a key (`avatar…`, `lumen…`) or, on a broker, the name of a queue, as in the modules of 2015.
        """
        ...

    @abstractmethod
    def close(self) -> None:
        """Deliver the published messages and end; a second call does nothing."""
        ...


@runtime_checkable
class BlockableBus(Protocol):
    """A bus whose broker may accept no messages for a while."""

    @property
    def blocked(self) -> str:
        """The resource that the broker lacks while it accepts no messages; empty while it accepts them."""
        ...


@runtime_checkable
class ReturningBus(Protocol):
    """A bus between processes that can say whether a published message has a receiver."""

    def returns(self, handler: Callable[[str], None]) -> None:
        """From now on, call `handler` with the key of each published message that has no receiver.

        The call may come on any thread; for messages published before `close`, it comes before `close` returns.
        """
        ...


@runtime_checkable
class SignsMessages(Protocol):
    """A bus whose messages carry the name of the program that sends them."""

    @property
    def sender(self) -> str: ...


@runtime_checkable
class CountsDrops(Protocol):
    """A bus that counts the messages that it dropped."""

    @property
    def dropped(self) -> Mapping[str, int]:
        """The number of dropped messages by key."""
        ...


@runtime_checkable
class KnowsListeners(Protocol):
    """A bus that can tell whether a message would have a receiver."""

    def heard(self, key: str) -> bool: ...


@runtime_checkable
class UsesBroker(Protocol):
    """A bus through a broker on a machine of the network."""

    @property
    def host(self) -> str:
        """The broker's machine."""
        ...

    @property
    def away(self) -> bool:
        """Whether the broker can't be reached now."""
        ...


@runtime_checkable
class EndsWithExhibition(Protocol):
    """A bus that an exhibition serves, and that ends with it."""

    @property
    def gone(self) -> Signal:
        """Set once the exhibition has ended."""
        ...
