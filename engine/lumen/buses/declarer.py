"""Makes queues on the broker, each over a channel of its own: what it refuses costs nothing else."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from pika.exceptions import ChannelClosedByBroker

from lumen.buses.queues import EXCHANGE, SETTLING, Queue, queue_of
from lumen.buses.subscriptions import Subscription

OTHERWISE = 406
"""The broker's code for a queue that exists and was made otherwise."""


class QueueDeclarer:
    """Makes and unmakes queues; remembers, also over an outage, which ones a crash could still lose."""

    def __init__(self) -> None:
        self.settling: set[str] = set()

    def make(self, connection: Any, queue: Queue) -> tuple[str, str]:
        """Declare and bind a queue; its name, and why the broker refuses."""
        for attempt in self._attempts(queue):
            channel = connection.channel()
            try:
                name = attempt(channel, queue)
                channel.close()
                return name, ""
            except ChannelClosedByBroker as error:
                refusal = str(error.reply_text)
                if error.reply_code != OTHERWISE:
                    break
        return "", refusal

    def leave(self, connection: Any, subscription: Subscription) -> None:
        """Nothing comes to its queue under its key any more; what is in there can still be read."""
        with suppress(ChannelClosedByBroker):
            channel = connection.channel()
            channel.queue_unbind(subscription.queue, EXCHANGE, subscription.pattern)
            channel.close()

    def unmake(self, connection: Any, subscription: Subscription) -> None:
        """A queue that outlives us, and that no other process reads, is bound to nothing any more.

        It is deleted if it is empty; a quorum queue can't be deleted so carefully, and stays.
        """
        with suppress(ChannelClosedByBroker):
            channel = connection.channel()
            self._unmake(channel, subscription)
            channel.close()

    def _unmake(self, channel: Any, subscription: Subscription) -> None:
        name, must = subscription.queue, subscription.must_arrive
        if must:
            if channel.queue_declare(name, passive=True).method.consumer_count:
                return
            channel.queue_unbind(name, EXCHANGE, subscription.pattern)
        if not queue_of("", subscription.route).quorum and (must or not subscription.tag):
            channel.queue_delete(name, if_unused=True, if_empty=must)

    def _attempts(self, queue: Queue) -> tuple[Callable[[Any, Queue], str], ...]:
        """One after the other, where there is a queue of that name that was made otherwise."""
        if queue.quorum:
            return self._found, _adopt
        return (_declare, _renew, _adopt) if queue.name else (_declare,)

    def _found(self, channel: Any, queue: Queue) -> str:
        """A quorum queue, which is bound when a crash of the broker can't lose it any more.

        Where the broker was killed before that, it has no log for it and never answers for it: it is made anew.
        """
        if queue.name in self.settling:
            channel.queue_delete(queue.name)
        if not _exists(channel, queue.name):
            self.settling.add(queue.name)
            channel.queue_declare(queue.name, durable=True, arguments=queue.arguments)
            channel.connection.sleep(SETTLING)
            self.settling.discard(queue.name)
        return _declare(channel, queue)


def _exists(channel: Any, name: str) -> bool:
    asking = channel.connection.channel()
    try:
        asking.queue_declare(name, passive=True)
    except ChannelClosedByBroker:
        return False
    asking.close()
    return True


def _declare(channel: Any, queue: Queue) -> str:
    mine = not queue.name
    made = channel.queue_declare(
        queue.name, durable=not mine, exclusive=mine, auto_delete=mine, arguments=queue.arguments
    )
    channel.queue_bind(made.method.queue, queue.exchange, queue.key)
    return str(made.method.queue)


def _renew(channel: Any, queue: Queue) -> str:
    """There is one of that name that was made otherwise: where it holds nothing, another takes its place."""
    channel.queue_delete(queue.name, if_unused=True, if_empty=True)
    return _declare(channel, queue)


def _adopt(channel: Any, queue: Queue) -> str:
    """Use the one that there is: nothing in it is lost, and it is made anew when it is empty."""
    channel.queue_bind(queue.name, EXCHANGE, queue.key)
    return queue.name
