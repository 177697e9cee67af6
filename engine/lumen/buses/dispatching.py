"""The thread that runs handlers, one at a time, so that a slow one keeps nobody's heart from beating."""

import logging
import queue
import threading
from collections.abc import Callable

from lumen.buses.bodies import JSON, decode
from lumen.buses.consuming import Delivery
from lumen.ports import Message

MARK = "lumen.mark"

_log = logging.getLogger(__name__)


class Dispatching:
    """Decodes deliveries and hands them to their handlers in the order received.

    `handled` is told of each delivery that is over. A delivery of type `MARK` only says that everything published
    before it has arrived.
    """

    def __init__(self, handled: Callable[[Delivery], None]) -> None:
        self._handled = handled
        self._waiting: queue.SimpleQueue[Delivery | None] = queue.SimpleQueue()
        self._marks: set[str] = set()
        self._marked = threading.Event()
        self._thread = threading.Thread(target=self._run, name="lumen-bus-handlers", daemon=True)
        self._thread.start()

    def receive(self, delivery: Delivery) -> None:
        self._waiting.put(delivery)

    @property
    def inside(self) -> bool:
        """Whether the caller is a handler."""
        return threading.current_thread() is self._thread

    def expect(self, marks: set[str]) -> threading.Event:
        """An event that is set when marks with all of these bodies have come through."""
        self._marks = marks
        if not marks:
            self._marked.set()
        return self._marked

    def end(self, timeout: float) -> bool:
        """Finish what has been received and end; whether that was done within `timeout` [s]."""
        self._waiting.put(None)
        if self.inside:
            return True
        self._thread.join(max(0.0, timeout))
        return not self._thread.is_alive()

    def _run(self) -> None:
        while (delivery := self._waiting.get()) is not None:
            if delivery.properties.type == MARK:
                self._pass(delivery.body.decode(errors="replace"))
            elif delivery.subscription.active:
                self._deliver(delivery)
            self._handled(delivery)

    def _pass(self, mark: str) -> None:
        if mark in self._marks:
            self._marks.discard(mark)
            if not self._marks:
                self._marked.set()

    def _deliver(self, delivery: Delivery) -> None:
        properties = delivery.properties
        try:
            body = decode(delivery.body, properties.content_type or JSON)
        except ValueError as error:
            _log.warning("a message on `%s` was dropped: %s", delivery.key, error)
            return
        try:
            message = Message(delivery.key, body, properties.reply_to or "", properties.correlation_id or "")
            delivery.subscription.handler(message)
        except Exception:
            _log.exception("a subscriber of `%s` failed on `%s`", delivery.subscription.pattern, delivery.key)
