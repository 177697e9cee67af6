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
    version: str
    address: object
    """Host, port and virtual host as text, without a password."""
    place: str
    """Host and port."""
    user: str

    def taking(self) -> str:
        """Return why the broker accepts no messages; empty if it does."""
        ...

    def reading(self, key: str) -> str:
        """Return why we may not read what is sent under a key; empty if we may."""
        ...

    def writing(self, key: str) -> str:
        """Return why we may not send under a key; empty if we may."""
        ...

    def served(self, key: str, route: Route) -> QueueStatus:
        """Return how a route's queue is read."""
        ...

    def misdeclared(self) -> Iterator[str]:
        """Iterate over what is wrong with the queues of unusable messages."""
        ...

    def close(self) -> None: ...


class StreamEntry(NamedTuple):
    """A message of a stream, at its `offset`, which is -1 in none; `body` is JSON data, None if it can't be read.

    `id` is unique, and `time` is when it was sent [s since 1970]: empty and 0 if the sender gave none.
    """

    offset: int
    key: str
    body: Any
    id: str = ""
    time: float = 0.0


class Stream(Protocol):
    """Reads a stream through all outages of the broker."""

    def take(self) -> list[StreamEntry]:
        """Return what was read since the last call, in the stream's order."""
        ...

    def close(self) -> None:
        """End; what was not taken is read again by the next one that begins there."""
        ...


def probe_of(url: str) -> Probe | None:
    """Return a connection for questions about the broker at an address; None if there is no broker.

    Raises BusError, saying what to do, if the broker can't be used.
    """
    row = row_of(url)
    if row is None or not row.probe:
        return None
    probe: Probe = called(owner("buses", url.partition(":")[0]), row.probe, url)
    return probe


def has_streams(url: str) -> bool:
    """Return whether buses of that kind can have streams."""
    return (row := row_of(url)) is not None and bool(row.stream)


def stream_of(url: str, name: str, first: int) -> Stream | None:
    """Read the stream of that name from the offset `first` on; None if the broker has no such stream.

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
