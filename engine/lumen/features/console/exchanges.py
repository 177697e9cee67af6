"""Messages of the console and what comes back: whether the bus has them, whether somebody takes them, the answers."""

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
"""Sent to ourselves behind a message: when it is back the bus has both, for it keeps their order."""


class Exchange:
    """One message and what comes back: `answers`, `echo` once the bus has it, `nobody` where nobody takes it."""

    def __init__(self) -> None:
        self.answers: asyncio.Queue[Any] = asyncio.Queue()
        self.echo, self.nobody = asyncio.Event(), asyncio.Event()

    async def taken(self, timeout: float) -> bool:
        """Whether the bus has it, and somebody takes it, known within `timeout` [s]."""
        return await _first(timeout, self.echo, self.nobody) and not self.nobody.is_set()

    async def answer(self, timeout: float) -> Any:
        """The next answer. Raises BusUnreachableError where there is none within `timeout` [s]."""
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
    """All that wait for answers over a link."""

    def __init__(self, link: BusLink) -> None:
        self._link = link
        self._open: dict[str, tuple[str, Exchange]] = {}

    def take(self, message: Message) -> None:
        """A message came on the key for answers, to us or to somebody else; in the loop."""
        if found := self._open.get(message.correlation_id):
            if message.body == ECHO:
                found[1].echo.set()
            else:
                found[1].answers.put_nowait(message.body)

    def ours(self, message: Message) -> bool:
        """Whether it is an answer that somebody waits for; any thread may ask."""
        return message.correlation_id in self._open

    def nobody_takes(self, key: str) -> None:
        """A message under this key came back; in the loop."""
        for sent, exchange in self._open.values():
            if sent == key:
                exchange.nobody.set()

    @contextmanager
    def send(self, key: str, body: Any, *, ttl: float, by: str = "", echo: bool = False) -> Iterator[Exchange]:
        """Send a message that is worth something for `ttl` [s], in somebody's name. Raises BusError where none goes."""
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
        """The first answer to a question. Raises BusError where there is none within `timeout` [s]."""
        with self.send(key, body, ttl=timeout) as exchange:
            return await exchange.answer(timeout)


async def _first(timeout: float, *events: asyncio.Event) -> bool:
    """Whether one of them is set within `timeout` [s]."""
    waiting = [asyncio.ensure_future(event.wait()) for event in events]
    try:
        done, _ = await asyncio.wait(waiting, timeout=timeout, return_when=asyncio.FIRST_COMPLETED)
        return bool(done)
    finally:
        for one in waiting:
            one.cancel()
