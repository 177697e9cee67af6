"""Declares queues on the broker, each over a separate channel, so a refusal affects no other queue."""

from collections.abc import Callable
from contextlib import suppress

from pika.exceptions import ChannelClosedByBroker

from lumen.features.rabbitmq.asked_channel import AskedChannel
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.features.rabbitmq.queues import EXCHANGE, QUORUM_SETTLE_TIME, Queue, queue_of
from lumen.features.rabbitmq.subscriptions import Subscription

PRECONDITION_FAILED = 406
"""AMQP's code for a queue that exists with other arguments."""


class QueueDeclarer:
    """Declares and deletes queues; `settling` names new queues that a crash of the broker can still lose."""

    def __init__(self) -> None:
        self.settling: set[str] = set()

    def declare(self, connection: PolledConnection, queue: Queue) -> tuple[str, str]:
        """Declare and bind a queue; return its name and an empty string, or an empty name and the broker's refusal."""
        for attempt in self._attempts(queue):
            try:
                with connection.asking() as channel:
                    return attempt(channel, queue), ""
            except ChannelClosedByBroker as error:
                refusal = str(error.reply_text)
                if error.reply_code != PRECONDITION_FAILED:
                    break
        return "", refusal

    def bind_again(self, connection: PolledConnection, subscription: Subscription) -> None:
        """Bind a consumed queue again, because a leaving process may have unbound it while it had no consumer."""
        with suppress(ChannelClosedByBroker), connection.asking() as channel:
            channel.queue_bind(subscription.queue, EXCHANGE, subscription.pattern)

    def unbind(self, connection: PolledConnection, subscription: Subscription) -> None:
        """Unbind a queue from its key; messages already in it can still be read."""
        with suppress(ChannelClosedByBroker), connection.asking() as channel:
            channel.queue_unbind(subscription.queue, EXCHANGE, subscription.pattern)

    def remove(self, connection: PolledConnection, subscription: Subscription) -> None:
        """Remove a queue unless another process reads it.

        A queue of messages that must arrive is unbound, and deleted only if it is empty. A quorum queue is kept:
        RabbitMQ can't delete it on that condition.
        """
        with suppress(ChannelClosedByBroker), connection.asking() as channel:
            self._remove(channel, subscription)

    def _remove(self, channel: AskedChannel, subscription: Subscription) -> None:
        name, must = subscription.queue, subscription.must_arrive
        if must:
            if _is_read(channel, name):
                return
            channel.queue_unbind(name, EXCHANGE, subscription.pattern)
            if _is_read(channel, name):  # another process subscribed in between
                channel.queue_bind(name, EXCHANGE, subscription.pattern)
                return
        if not queue_of("", subscription.route).quorum and (must or not subscription.tag):
            channel.queue_delete(name, if_unused=True, if_empty=must)

    def _attempts(self, queue: Queue) -> tuple[Callable[[AskedChannel, Queue], str], ...]:
        """Return the declarations to try in order while an existing queue has different arguments."""
        if queue.quorum:
            return self._declare_quorum, _adopt
        return (_declare, _renew, _adopt) if queue.name else (_declare,)

    def _declare_quorum(self, channel: AskedChannel, queue: Queue) -> str:
        """Declare a quorum queue, and bind it only when a crash of the broker can no longer lose its content.

        A broker that is killed earlier has no log for the queue and never answers requests about it. The queue is then
        deleted and declared again.
        """
        if queue.name in self.settling:
            channel.queue_delete(queue.name)
        if not _exists(channel, queue.name):
            self.settling.add(queue.name)
            channel.queue_declare(queue.name, durable=True, arguments=queue.arguments)
            channel.connection.pause(QUORUM_SETTLE_TIME)
            self.settling.discard(queue.name)
        return _declare(channel, queue)


def _exists(channel: AskedChannel, name: str) -> bool:
    try:
        with channel.connection.asking() as other:
            other.queue_declare(name, passive=True)
    except ChannelClosedByBroker:
        return False
    return True


def _is_read(channel: AskedChannel, name: str) -> bool:
    return bool(channel.queue_declare(name, passive=True).method.consumer_count)


def _declare(channel: AskedChannel, queue: Queue) -> str:
    exclusive = not queue.name
    declared = channel.queue_declare(
        queue.name, durable=not exclusive, exclusive=exclusive, auto_delete=exclusive, arguments=queue.arguments
    )
    channel.queue_bind(declared.method.queue, queue.exchange, queue.key)
    return str(declared.method.queue)


def _renew(channel: AskedChannel, queue: Queue) -> str:
    """Replace an existing queue that has different arguments, if it is empty and unused."""
    channel.queue_delete(queue.name, if_unused=True, if_empty=True)
    return _declare(channel, queue)


def _adopt(channel: AskedChannel, queue: Queue) -> str:
    """Bind the existing queue despite its different arguments, which preserves its messages."""
    channel.queue_bind(queue.name, EXCHANGE, queue.key)
    return queue.name
