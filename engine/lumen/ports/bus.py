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
    """A message as a subscriber receives it."""

    key: str
    """The key, which names the topic."""
    body: Any
    """JSON data."""
    reply_to: str = ""
    """The key for answers; empty if the sender wants no answer."""
    correlation_id: str = ""
    """A text that identifies the request in its answers."""
    id: str = ""
    """The id, which no other message has."""
    sender: str = ""
    """The program that sent it; empty if unknown."""
    time: float = 0.0
    """When it was sent according to the sender, else when it arrived [s since 1970, UTC]."""
    cause: str = ""
    """The part of a behaviour that caused it, as in `MessageOrigin`."""


MessageHandler = Callable[[Message], None]

Ability = TypeVar("Ability")

PREFIX, NUMBERS = urandom(5).hex(), count(1)
"""The parts of each message id: a prefix of this process, and a number."""

_new = tuple.__new__  # half the cost of Outgoing(…), which each message pays


class Outgoing(NamedTuple):
    """A message to send; `Bus.publish` and `MessageOrigin` describe the fields. `publish` sets the `id`."""

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
    """A bus for messages by topic: in a pattern, `*` matches one word of the key, `#` any number.

    A custom bus inherits from this class and implements the abstract methods. An ability of only some buses has a
    protocol of its own, such as `CountsDrops`; `ability` returns a bus with it.
    """

    def ability(self, kind: type[Ability]) -> Ability | None:
        """Return this bus if it has that ability, else None. A wrapper delegates to the bus inside it."""
        return self if isinstance(self, kind) else None

    @abstractmethod
    def carry(self, routes: Mapping[str, Route]) -> None:
        """From now on, carry messages with these keys as their routes specify, and all others as telemetry."""
        ...

    @abstractmethod
    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Prepare `carry`, and subscriptions to the incoming routes, so that neither waits later.

        This may wait for the network, so call it on a background thread. Raises BusError if the broker refuses a route.
        """
        ...

    @abstractmethod
    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        """Call `handler` with each matching message, one by one, in order; call the result to end this.

        An exception in a handler is logged, and affects neither the bus nor the publisher.
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
        """Send a body (JSON data), from any thread. Raises BusError after `close`, or if the body is not JSON data.

        Answers go to the key `reply_to` and carry `correlation_id`. A message that waits longer than `ttl` [s] may be
        discarded; None means the limit of its route. The bus sets the fields that `origin` leaves empty: a unique id,
        its own `sender`, and the time.
        """
        id, sender, time, cause = origin
        id = id or f"{PREFIX}-{next(NUMBERS)}"
        self.send(_new(Outgoing, (key, body, reply_to, correlation_id, ttl, id, sender, time, cause)))

    @abstractmethod
    def send(self, message: Outgoing) -> None:
        """Send a message as `publish` does.

        It never waits for a handler on another thread, nor for the network. A bus without its own thread (`memory://`)
        may run handlers inside `send` if no other thread is delivering; so a handler should only enqueue.
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
        """Deliver the published messages and close the bus; a second call does nothing."""
        ...


@runtime_checkable
class BlockableBus(Protocol):
    """A bus whose broker may temporarily refuse messages."""

    @property
    def blocked(self) -> str:
        """Return the resource that the broker lacks while it refuses messages; empty while it accepts them."""
        ...


@runtime_checkable
class ReturningBus(Protocol):
    """A bus between processes that can report messages without a receiver."""

    def returns(self, handler: Callable[[str], None]) -> None:
        """From now on, call `handler` with the key of each published message that has no receiver.

        The call may come on any thread; for messages published before `close`, it comes before `close` returns.
        """
        ...


@runtime_checkable
class SignsMessages(Protocol):
    """A bus whose messages carry the name of the program that sends them."""

    @property
    def sender(self) -> str:
        """Return the name of the program."""
        ...


@runtime_checkable
class CountsDrops(Protocol):
    """A bus that counts the messages that it dropped."""

    @property
    def dropped(self) -> Mapping[str, int]:
        """Return the number of dropped messages by key."""
        ...


@runtime_checkable
class KnowsListeners(Protocol):
    """A bus that can determine whether a message would have a receiver."""

    def heard(self, key: str) -> bool:
        """Return True if a message with that key would have a receiver."""
        ...


@runtime_checkable
class UsesBroker(Protocol):
    """A bus that uses a broker in the network."""

    @property
    def host(self) -> str:
        """Return the host of the broker."""
        ...

    @property
    def away(self) -> bool:
        """Return True if the broker can't be reached now."""
        ...


@runtime_checkable
class EndsWithExhibition(Protocol):
    """A bus that an exhibition serves, and that ends with the exhibition."""

    @property
    def gone(self) -> Signal:
        """Return a signal that is set once the exhibition has ended."""
        ...
