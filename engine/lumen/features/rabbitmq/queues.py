"""The queues that Lumen declares on a broker: one for every way of carrying messages, and two for unusable ones.

Telemetry has a queue that vanishes with its reader and keeps the newest messages. Commands have one that survives a
reader's absence as long as a command is valid; expired ones go to `lumen.dead`. An incoming journal has a quorum queue,
an outgoing one a stream, which any number of modules may read. All of them are bounded: what does not fit is refused to
the sender, or displaces the oldest if it may be lost.
"""

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.features.rabbitmq.asked_channel import AskedChannel
from lumen.language.routes import Carried, Route

EXCHANGE = "amq.topic"
DEAD_LETTERS = "lumen.dead"
"""The queue of unusable messages, with the reason in their headers."""
UNROUTED = "lumen.nowhere"
"""The queue of messages without a receiver; the alternate exchange of `amq.topic` if a policy sets it."""
SIDE_QUEUES = f"{DEAD_LETTERS} and {UNROUTED}"

MAX_LENGTH_WITHOUT_ROUTE = 20_000
"""The maximum length of a queue for a key without a route; the oldest messages are dropped beyond it."""
MAX_LENGTH_TELEMETRY = 1_000
"""The maximum length of a telemetry queue whose route has no `keep`; the oldest messages are dropped beyond it."""
MAX_LENGTH_COMMANDS = 100_000
"""The maximum length of a queue of commands; beyond it, the broker refuses further ones."""
MAX_JOURNAL_BYTES = 10**9
"""The maximum size of a journal's queue or stream [bytes]."""
MAX_SIDE_QUEUE_BYTES = 10**8
"""The maximum size of `lumen.dead` and of `lumen.nowhere`, each [bytes]."""
MAX_QUEUE_NAME_BYTES = 255
"""The longest short string of AMQP; a longer name is replaced by its hash."""
HOUR = 60 * 60 * 1000
"""One hour in RabbitMQ's unit [ms]."""
UNUSED_EXPIRY = 10 * 60 * 1000
"""The time without a reader after which a queue of commands is deleted [ms]."""
QUORUM_SETTLE_TIME = 1.0
"""The time for which a new quorum queue stays unbound [s].

RabbitMQ saves which log belongs to the queue half a second after the declaration; if it is killed before, the queue's
content is lost (docs/decisions).
"""

SIDE_EXCHANGE = "fanout"
"""The type of the side queues' exchanges: each message reaches the queue, whatever its key."""
SIDE_QUEUE_LIMITS: Mapping[str, Mapping[str, Any]] = {
    name: {
        "x-max-length": MAX_LENGTH_TELEMETRY,
        "x-max-length-bytes": MAX_SIDE_QUEUE_BYTES,
        "x-message-ttl": lifetime,
    }
    for name, lifetime in ((DEAD_LETTERS, 7 * 24 * HOUR), (UNROUTED, HOUR))
}
"""The arguments of the side queues, by name."""
OTHERWISE = 406
"""AMQP's code for a queue or an exchange that exists with other arguments."""
_OTHER_ARGUMENT = re.compile(
    r"inequivalent arg '([^']+)' for (exchange|queue) '([^']+)' in vhost .*: received (.*) but current is (.*)"
)


@dataclass(frozen=True)
class Queue:
    """A queue on the broker; one without a name belongs to this connection and ends with it."""

    key: str
    name: str = ""
    exchange: str = EXCHANGE
    arguments: dict[str, Any] = field(default_factory=dict)

    @property
    def quorum(self) -> bool:
        """Whether this is a quorum queue."""
        return self.arguments.get("x-queue-type") == "quorum"

    def declare(self, channel: AskedChannel) -> None:
        """Declare a queue with a name, and bind it to its key."""
        channel.queue_declare(self.name, durable=True, arguments=self.arguments)
        channel.queue_bind(self.name, EXCHANGE, self.key)


def queue_of(key: str, route: Route | None, number: int = 0, exchange: str = EXCHANGE) -> Queue:
    """Return the queue for messages that arrive under a key; `number` distinguishes several of the same key."""
    if route is None or not route.must_arrive:
        newest = MAX_LENGTH_WITHOUT_ROUTE if route is None else route.keep or MAX_LENGTH_TELEMETRY
        return Queue(
            key, exchange=exchange, arguments={"x-max-length": newest, "x-overflow": "drop-head", **_lifetime(route)}
        )
    if route.carried is Carried.JOURNAL:
        limits = {
            "x-max-length-bytes": MAX_JOURNAL_BYTES,
            "x-overflow": "reject-publish",
            "x-dead-letter-exchange": DEAD_LETTERS,
        }
        kept = {"x-queue-type": "quorum", **limits, "x-single-active-consumer": True}
        return Queue(key, _name(f"lumen.inbox.{key}", number), exchange, kept)
    name = _name(f"lumen.queue.{key}", number)
    limits = {
        "x-max-length": MAX_LENGTH_COMMANDS,
        "x-overflow": "reject-publish",
        "x-dead-letter-exchange": DEAD_LETTERS,
    }
    unused = {"x-expires": UNUSED_EXPIRY} if route.lifetime else {}
    return Queue(key, name, exchange, {**limits, **_lifetime(route), **unused, "x-single-active-consumer": True})


def journal_of(key: str) -> Queue:
    """Return the stream of an outgoing journal, of at most a month and a gigabyte.

    Each module continues to read after the last message that it has read.
    """
    arguments = {"x-queue-type": "stream", "x-max-age": "30D", "x-max-length-bytes": MAX_JOURNAL_BYTES}
    return Queue(key, _name(f"lumen.journal.{key}"), arguments=arguments)


def declare_side_queues(channel: AskedChannel) -> None:
    """Declare the queues for unusable messages and those without a receiver: bounded, the oldest are dropped."""
    for name, limits in SIDE_QUEUE_LIMITS.items():
        channel.exchange_declare(name, SIDE_EXCHANGE, durable=True)
        channel.queue_declare(name, durable=True, arguments=limits)
        channel.queue_bind(name, name, "")


def declared_otherwise(reply: str) -> str:
    """Describe how an existing exchange or queue differs from the declaration, and the remedy.

    `reply` is the broker's answer to Lumen's declaration.
    """
    found = _OTHER_ARGUMENT.search(reply)
    if not found:
        return reply
    argument, kind, name, wanted, there = found.groups()
    delete = f"rabbitmqctl delete_queue {name}" if kind == "queue" else f"rabbitmqadmin delete exchange name={name}"
    return (
        f"the {kind} `{name}` was declared with other arguments (its `{argument}` is {there}, not {wanted}), and its"
        f" messages are lost: run `{delete}`, then restart the programs that use it"
    )


def _lifetime(route: Route | None) -> dict[str, int]:
    return {"x-message-ttl": max(1, round(1000 * route.lifetime))} if route and route.lifetime else {}


def _name(name: str, number: int = 0) -> str:
    name = f"{name}.{number + 1}" if number else name
    if len(name.encode()) <= MAX_QUEUE_NAME_BYTES:
        return name
    return f"lumen.queue.{hashlib.sha256(name.encode()).hexdigest()}"
