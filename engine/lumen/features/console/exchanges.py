"""The console's messages, followed until the bus has accepted or returned them, and their answers."""

import asyncio
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from lumen.errors import BusClosedError, BusUnreachableError
from lumen.features.console.bus_link import BusLink
from lumen.language.causes import MessageOrigin
from lumen.ports import Message
from lumen.run.asking import OPERATOR_ANSWERS

ECHO = {"console": "echo"}
"""Sent to the console itself after a message: the bus keeps their order, so the echo shows that it has both."""


class Exchange:
    """One message with its `answers`; `echo` is set when the bus has it, `nobody` if no process receives it."""

    def __init__(self) -> None:
        self.answers: asyncio.Queue[Any] = asyncio.Queue()
        self.echo, self.nobody = asyncio.Event(), asyncio.Event()

    async def taken(self, timeout: float) -> bool:
        """Return True if the bus accepts the message within `timeout` [s] and does not return it as undeliverable."""
        return await _first(timeout, self.echo, self.nobody) and not self.nobody.is_set()

    async def answer(self, timeout: float) -> Any:
        """Return the next answer. Raises BusUnreachableError after `timeout` [s], or if no process gets the message."""
        nobody = asyncio.ensure_future(self.nobody.wait())
        answer = asyncio.ensure_future(self.answers.get())
        try:
            await asyncio.wait((nobody, answer), timeout=timeout, return_when=asyncio.FIRST_COMPLETED)
            if not answer.done():
                raise BusUnreachableError("no answer came")
            return answer.result()
        finally:
            nobody.cancel()
            answer.cancel()


class Exchanges:
    """All open exchanges over one link."""

    def __init__(self, link: BusLink) -> None:
        self._link = link
        self._open: dict[str, tuple[str, Exchange]] = {}

    def take(self, message: Message) -> None:
        """Pass an answer to its open exchange; ignore messages of other senders. Call it in the event loop."""
        if found := self._open.get(message.correlation_id):
            if message.body == ECHO:
                found[1].echo.set()
            else:
                found[1].answers.put_nowait(message.body)

    def ours(self, message: Message) -> bool:
        """Return True if an open exchange waits for this answer. Any thread may call it."""
        return message.correlation_id in self._open

    def nobody_takes(self, key: str) -> None:
        """Mark the open exchanges with this key as received by no process. Call it in the event loop."""
        for sent, exchange in self._open.values():
            if sent == key:
                exchange.nobody.set()

    @contextmanager
    def send(self, key: str, body: Any, *, ttl: float, by: str = "", echo: bool = False) -> Iterator[Exchange]:
        """Send a message that expires after `ttl` [s], and yield its exchange. Raises BusError if it can't be sent."""
        bus = self._link.bus
        if bus is None:
            raise BusClosedError(self._link.trouble or "there is no bus")
        mark, exchange = f"console-{uuid.uuid4().hex}", Exchange()
        self._open[mark] = key, exchange
        try:
            origin = MessageOrigin(sender=by)
            bus.publish(key, body, reply_to=OPERATOR_ANSWERS, correlation_id=mark, ttl=ttl, origin=origin)
            if echo:
                bus.publish(OPERATOR_ANSWERS, ECHO, correlation_id=mark, ttl=ttl)
            yield exchange
        finally:
            del self._open[mark]

    async def request(self, key: str, body: Any, timeout: float) -> Any:
        """Send a question and return the first answer. Raises BusError if none arrives within `timeout` [s]."""
        with self.send(key, body, ttl=timeout) as exchange:
            return await exchange.answer(timeout)


async def _first(timeout: float, *events: asyncio.Event) -> bool:
    """Return True if one of the events is set within `timeout` [s]."""
    waiting = [asyncio.ensure_future(event.wait()) for event in events]
    try:
        done, _ = await asyncio.wait(waiting, timeout=timeout, return_when=asyncio.FIRST_COMPLETED)
        return bool(done)
    finally:
        for one in waiting:
            one.cancel()
