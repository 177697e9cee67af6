"""Probes and streams of a broker: answers about itself, and messages that it keeps. Rows of buses have both."""

from collections.abc import Iterator
from typing import Any, NamedTuple, Protocol

from lumen.bus.addresses import row_of
from lumen.feature import owner
from lumen.language.routes import Route
from lumen.project.broken_features import called


class QueueStatus(NamedTuple):
    """The numbers of waiting messages and of readers of a route's queue; both None if there is no such queue."""

    waiting: int | None = None
    readers: int | None = None


class Probe(Protocol):
    """A connection for questions about a broker, which no other program notices."""

    product: str
    """Name of the broker's software."""
    version: str
    """The version of the broker's software."""
    address: object
    """Host, port and virtual host as text, without a password."""
    place: str
    """Host and port."""
    user: str
    """Name of the user of the connection."""

    def taking(self) -> str:
        """Return why the broker accepts no messages; empty if it does."""
        ...

    def reading(self, key: str) -> str:
        """Return why this user may not read messages under a key; empty if that is allowed."""
        ...

    def writing(self, key: str) -> str:
        """Return why this user may not send under a key; empty if that is allowed."""
        ...

    def served(self, key: str, route: Route) -> QueueStatus:
        """Return how many messages wait in a route's queue, and how many programs read it."""
        ...

    def misdeclared(self) -> Iterator[str]:
        """Yield each fault in the declarations of the queues for unusable messages, in words."""
        ...

    def close(self) -> None:
        """Disconnect."""
        ...


class StreamEntry(NamedTuple):
    """A message of a stream."""

    offset: int
    """The offset of the message; -1 if it is not from a stream."""
    key: str
    """The routing key under which the message was sent."""
    body: Any
    """The body as JSON data; None if it can't be read."""
    id: str = ""
    """The unique id of the message; empty if the sender gave none."""
    time: float = 0.0
    """When the message was sent [s since 1970]; 0 if the sender gave no time."""


class Stream(Protocol):
    """A reader of a stream that survives outages of the broker."""

    def take(self) -> list[StreamEntry]:
        """Return the entries that were read since the last call, in the stream's order."""
        ...

    def close(self) -> None:
        """Stop reading; a later reader can still read the entries that were not taken."""
        ...


def probe_of(url: str) -> Probe | None:
    """Return a connection for questions about the broker at an address; None if that kind of bus has no broker.

    Raises BusError, with advice, if the broker can't be used.
    """
    row = row_of(url)
    if row is None or not row.probe:
        return None
    probe: Probe = called(owner("buses", url.partition(":")[0]), row.probe, url)
    return probe


def has_streams(url: str) -> bool:
    """Return whether buses at such an address can have streams."""
    return (row := row_of(url)) is not None and bool(row.stream)


def stream_of(url: str, name: str, first: int) -> Stream | None:
    """Read a stream from the offset `first` on; return None if there is no such stream, or that bus can't have any.

    Raises BusError if the broker can't be reached.
    """
    row = row_of(url)
    if row is None or not row.stream:
        return None
    stream: Stream | None = called(owner("buses", url.partition(":")[0]), row.stream, url, name, first)
    return stream


def side_queues(url: str) -> str:
    """Return the names of the queues in which a broker keeps unusable messages; empty if it has no such queue."""
    row = row_of(url)
    return row.side_queues if row else ""
