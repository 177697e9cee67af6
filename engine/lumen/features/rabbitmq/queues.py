"""The queues that Lumen declares on a broker: one type for each kind of route, and two side queues.

Telemetry uses a queue that is deleted with its reader and keeps the newest messages. Commands use a queue that outlasts
its reader's absence; expired commands move to `lumen.dead`. An incoming journal uses a quorum queue. An outgoing
journal uses a stream, which any number of modules can read. All queues are bounded: a full queue refuses messages that
must arrive, and drops its oldest messages if they may be lost.
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
"""The queue of messages without a receiver; its exchange is the alternate of `amq.topic` if a policy sets it."""
SIDE_QUEUES = f"{DEAD_LETTERS} and {UNROUTED}"

MAX_LENGTH_WITHOUT_ROUTE = 20_000
"""The maximum number of messages in the queue of a key without a route; beyond it, the oldest are dropped."""
MAX_LENGTH_TELEMETRY = 1_000
"""The maximum number of messages in a telemetry queue without `keep`; beyond it, the oldest are dropped."""
MAX_LENGTH_COMMANDS = 100_000
"""The maximum number of messages in a queue of commands; beyond it, the broker refuses further commands."""
MAX_JOURNAL_BYTES = 10**9
"""The maximum size of a journal's queue or stream [bytes]."""
MAX_SIDE_QUEUE_BYTES = 10**8
"""The maximum size of `lumen.dead` and of `lumen.nowhere`, each [bytes]."""
MAX_QUEUE_NAME_BYTES = 255
"""The maximum length of AMQP's short strings [bytes]; a longer name is replaced by its hash."""
HOUR = 60 * 60 * 1000
"""One hour in RabbitMQ's unit of time [ms]."""
UNUSED_EXPIRY = 10 * 60 * 1000
"""The time without a reader after which a queue of commands with a lifetime is deleted [ms]."""
QUORUM_SETTLE_TIME = 1.0
"""The time for which a new quorum queue stays unbound [s].

RabbitMQ saves the queue's assignment to a log half a second after the declaration. If it is killed earlier, the queue's
content is lost (docs/decisions).
"""

SIDE_EXCHANGE = "fanout"
"""The type of the side queues' exchanges: each message reaches the queue, regardless of its key."""
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
    """A queue on the broker; a queue without a name belongs to one connection and is deleted with it."""

    key: str
    name: str = ""
    exchange: str = EXCHANGE
    arguments: dict[str, Any] = field(default_factory=dict)

    @property
    def quorum(self) -> bool:
        """Whether this is a quorum queue."""
        return self.arguments.get("x-queue-type") == "quorum"

    def declare(self, channel: AskedChannel) -> None:
        """Declare this named queue as durable, and bind it to its key."""
        channel.queue_declare(self.name, durable=True, arguments=self.arguments)
        channel.queue_bind(self.name, EXCHANGE, self.key)


def queue_of(key: str, route: Route | None, number: int = 0, exchange: str = EXCHANGE) -> Queue:
    """Return the queue for messages that arrive under a key; `number` distinguishes several queues for one key."""
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
    """Return the stream of an outgoing journal, which keeps at most 30 days and MAX_JOURNAL_BYTES.

    Each module resumes after the last message that it has read.
    """
    arguments = {"x-queue-type": "stream", "x-max-age": "30D", "x-max-length-bytes": MAX_JOURNAL_BYTES}
    return Queue(key, _name(f"lumen.journal.{key}"), arguments=arguments)


def declare_side_queues(channel: AskedChannel) -> None:
    """Declare the bounded queues for unusable messages and for messages without a receiver."""
    for name, limits in SIDE_QUEUE_LIMITS.items():
        channel.exchange_declare(name, SIDE_EXCHANGE, durable=True)
        channel.queue_declare(name, durable=True, arguments=limits)
        channel.queue_bind(name, name, "")


def declared_otherwise(reply: str) -> str:
    """Describe how an existing exchange or queue differs from the declaration, and the remedy.

    `reply` is the broker's answer to Lumen's declaration. An answer in an unknown form is returned unchanged.
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
