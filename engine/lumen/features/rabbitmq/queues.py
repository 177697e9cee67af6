"""What we declare on a broker: a queue for every way of being carried, and places for what nobody could use.

Telemetry has a queue that goes away with its reader and keeps the newest. A command has one that outlives a reader's
absence for as long as the command is good for; then it is dead, with the others in `lumen.dead`. A journal that comes
in has a quorum queue, one that goes out a stream, from which any number of modules may read. Nothing here grows without
bound: what can't be kept is refused to the sender, or is the oldest of what may be lost.
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
"""Where messages go that could not be used, with the reason in their headers."""
UNROUTED = "lumen.nowhere"
"""Where messages go that nobody waits for; the alternate exchange of `amq.topic` where a policy says so."""
SIDE_QUEUES = f"{DEAD_LETTERS} and {UNROUTED}"

MAX_LENGTH_WITHOUT_ROUTE = 20_000
"""Messages in a queue for a key that no route has; then the oldest give way."""
MAX_LENGTH_TELEMETRY = 1_000
"""Messages in a queue of telemetry whose route does not say how many to `keep`."""
MAX_LENGTH_COMMANDS = 100_000
"""Messages in a queue of commands; then the broker refuses the sender."""
MAX_JOURNAL_BYTES = 10**9
"""Size of a journal's queue or stream [bytes]."""
MAX_SIDE_QUEUE_BYTES = 10**8
"""Size of `lumen.dead` and of `lumen.nowhere` [bytes]."""
MAX_QUEUE_NAME_BYTES = 255
"""AMQP's bound on a short string; a longer name is replaced by its hash."""
HOUR = 60 * 60 * 1000
"""[ms], as RabbitMQ counts."""
UNUSED_EXPIRY = 10 * 60 * 1000
"""After how long without a reader a queue of commands goes away [ms]."""
QUORUM_SETTLE_TIME = 1.0
"""How long a new quorum queue stays unbound [s]: RabbitMQ writes down half a second later which log is whose; killed
before that, it loses what the queue held (docs/decisions)."""

SIDE_EXCHANGE = "fanout"
"""The type of the exchanges in front of the side queues: each message goes to the queue, whatever its key."""
SIDE_QUEUE_LIMITS: Mapping[str, Mapping[str, Any]] = {
    name: {
        "x-max-length": MAX_LENGTH_TELEMETRY,
        "x-max-length-bytes": MAX_SIDE_QUEUE_BYTES,
        "x-message-ttl": lifetime,
    }
    for name, lifetime in ((DEAD_LETTERS, 7 * 24 * HOUR), (UNROUTED, HOUR))
}
"""The side queues, each with its arguments."""
OTHERWISE = 406
"""AMQP's code for a queue or an exchange that exists with other arguments."""
_OTHER_ARGUMENT = re.compile(
    r"inequivalent arg '([^']+)' for (exchange|queue) '([^']+)' in vhost .*: received (.*) but current is (.*)"
)


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

    def declare(self, channel: AskedChannel) -> None:
        """Declare one that has a name, and bind it to its key."""
        channel.queue_declare(self.name, durable=True, arguments=self.arguments)
        channel.queue_bind(self.name, EXCHANGE, self.key)


def queue_of(key: str, route: Route | None, number: int = 0, exchange: str = EXCHANGE) -> Queue:
    """The queue for what comes in under a key; `number` tells those of the same key apart."""
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
    """The stream of a journal that goes out: a month or a gigabyte, from which modules read where they left off."""
    arguments = {"x-queue-type": "stream", "x-max-age": "30D", "x-max-length-bytes": MAX_JOURNAL_BYTES}
    return Queue(key, _name(f"lumen.journal.{key}"), arguments=arguments)


def declare_side_queues(channel: AskedChannel) -> None:
    """Declare the places for what nobody could use: bounded, the oldest gives way."""
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
