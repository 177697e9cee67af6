"""What we make on a broker: a queue for every way of being carried, and the places for what nobody could use.

Telemetry has a queue that goes away with its reader and keeps the newest. A command has one that outlives a reader's
absence for as long as the command is good for; then it is dead, with the others in `lumen.dead`. A journal that comes
in has a quorum queue, one that goes out a stream, from which any number of modules may read. Nothing here grows without
bound: what can't be kept is refused to the sender, or is the oldest of what may be lost.
"""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from lumen.language.routes import Carried, Route

EXCHANGE = "amq.topic"
DEAD = "lumen.dead"
"""Where messages go that could not be used, with the reason in their headers."""
NOWHERE = "lumen.nowhere"
"""Where messages go that nobody waits for; the alternate exchange of `amq.topic` where a policy says so."""
ASIDE = f"{DEAD} and {NOWHERE}"

WAITING = 20_000
NEWEST = 1_000
MOST = 100_000
UNUSED = 10 * 60 * 1000
HOUR = 60 * 60 * 1000
GIGABYTE = 10**9
LONGEST = 255
SETTLING = 1.0
"""How long a new quorum queue stays unbound [s]: RabbitMQ writes down half a second later which log is whose; killed
before that, it loses what the queue held (docs/decisions)."""

ChannelCall = Callable[..., Any]
"""Calls a method of a channel with these arguments and waits for the answer."""


@dataclass(frozen=True)
class Queue:
    """A queue on the broker; without a name it is ours alone, and gone with us."""

    key: str
    name: str = ""
    exchange: str = EXCHANGE
    arguments: dict[str, Any] = field(default_factory=dict)

    @property
    def quorum(self) -> bool:
        return self.arguments.get("x-queue-type") == "quorum"

    def declare(self, call: ChannelCall, channel: Any) -> None:
        """Make one that has a name, and bind it to its key."""
        call(channel.queue_declare, self.name, durable=True, arguments=self.arguments)
        call(channel.queue_bind, self.name, EXCHANGE, self.key)


def queue_of(key: str, route: Route | None, number: int = 0, exchange: str = EXCHANGE) -> Queue:
    """The queue for what comes in under a key; `number` tells those of the same key apart."""
    if route is None or not route.must_arrive:
        newest = WAITING if route is None else route.keep or NEWEST
        return Queue(
            key, exchange=exchange, arguments={"x-max-length": newest, "x-overflow": "drop-head", **_lifetime(route)}
        )
    if route.carried is Carried.JOURNAL:
        limits = {"x-max-length-bytes": GIGABYTE, "x-overflow": "reject-publish", "x-dead-letter-exchange": DEAD}
        kept = {"x-queue-type": "quorum", **limits, "x-single-active-consumer": True}
        return Queue(key, _name(f"lumen.inbox.{key}", number), exchange, kept)
    name = _name(f"lumen.queue.{key}", number)
    limits = {"x-max-length": MOST, "x-overflow": "reject-publish", "x-dead-letter-exchange": DEAD}
    unused = {"x-expires": UNUSED} if route.lifetime else {}
    return Queue(key, name, exchange, {**limits, **_lifetime(route), **unused, "x-single-active-consumer": True})


def journal_of(key: str) -> Queue:
    """The stream of a journal that goes out: a month or a gigabyte, from which modules read where they left off."""
    arguments = {"x-queue-type": "stream", "x-max-age": "30D", "x-max-length-bytes": GIGABYTE}
    return Queue(key, _name(f"lumen.journal.{key}"), arguments=arguments)


def declare_aside(call: ChannelCall, channel: Any) -> None:
    """Make the places for what nobody could use: bounded, the oldest gives way."""
    for name, lifetime in ((DEAD, 7 * 24 * HOUR), (NOWHERE, HOUR)):
        limits = {"x-max-length": NEWEST, "x-max-length-bytes": GIGABYTE // 10, "x-message-ttl": lifetime}
        call(channel.exchange_declare, name, "fanout", durable=True)
        call(channel.queue_declare, name, durable=True, arguments=limits)
        call(channel.queue_bind, name, name, "")


def _lifetime(route: Route | None) -> dict[str, int]:
    return {"x-message-ttl": max(1, round(1000 * route.lifetime))} if route and route.lifetime else {}


def _name(name: str, number: int = 0) -> str:
    name = f"{name}.{number + 1}" if number else name
    if len(name.encode()) <= LONGEST:
        return name
    return f"lumen.queue.{hashlib.sha256(name.encode()).hexdigest()}"
