"""Commands from pages, each sent only once per id and followed until its outcome is known."""

import asyncio
import time
from collections import OrderedDict
from contextlib import suppress
from typing import Any

import orjson

from lumen.errors import BusError, BusUnreachableError
from lumen.features.console.exchanges import Exchange
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.orders import REST, Fields, Order, order_of
from lumen.features.console.people import Person
from lumen.features.console.requests import ALL
from lumen.features.console.streams import Streams
from lumen.features.console.watch import Watch
from lumen.language.operator_requests import NOTE
from lumen.run.presence import ROBOT_PART
from lumen.run.resting import STOP_TIMEOUT, no_robot, stop_behavior

SENT_TIMEOUT = 0.8
"""A message that the bus has not accepted after this long counts as unsent [s]."""
REST_TTL = 5.0
"""The time to live of a command to rest [s], equal to that of the route `stop`."""
LOOK_PERIOD = 0.02
"""The time between two checks for the presence of a robot that must rest [s]."""
PRESENCE_PATIENCE = 1.5
"""After a command to rest, a robot that seems absent may still report its presence for this long [s]."""
MAX_REMEMBERED = 1_000
FINISHED, FAILED, UNSENT, SENT = "finished", "failed", "unsent", "sent"


class PageCommand:
    """One command: `sent` is set when the bus has accepted or refused it, `over` when its outcome is known."""

    def __init__(self, id: str, robot: str, command: str, by: str) -> None:
        self.id, self.robot, self.command, self.by = id, robot, command, by
        self.state, self.reason, self.seconds = "", "", 0.0
        self.sent, self.over = asyncio.Event(), asyncio.Event()
        self.more: dict[str, Any] = {}
        self._began = time.monotonic()

    def become(self, state: str, reason: str = "") -> None:
        self.state, self.reason, self.seconds = state, reason, round(time.monotonic() - self._began, 3)
        self.sent.set()
        if state != SENT:
            self.over.set()

    def to_json(self) -> dict[str, Any]:
        """Return the answer to the sending page; `seconds` is the time from the command's arrival to its state."""
        return {"id": self.id, "state": self.state, "seconds": self.seconds, "reason": self.reason, **self.more}

    def block(self) -> bytes:
        """Return the command as a server-sent event for all pages."""
        told = {"robot": self.robot, "command": self.command, "by": self.by, **self.to_json()}
        return b"event: command\ndata: " + orjson.dumps(told) + b"\n\n"


class Commands:
    """Sends the commands of all pages over one watch, and reports them to all pages through `streams`."""

    def __init__(self, watch: Watch, streams: Streams) -> None:
        self._watch, self._streams = watch, streams
        self._known: OrderedDict[str, PageCommand] = OrderedDict()
        self._tasks = set[asyncio.Task[None]]()

    def send(self, id: str, robot: str, command: str, fields: Fields, person: Person) -> PageCommand:
        """Start sending a command to a robot, or to all robots if `robot` is ALL, and return it.

        If the id is known, return its earlier command and send nothing.

        Raises UsageError if the command is malformed.
        """
        if known := self._known.get(id):
            return known
        one = PageCommand(id, robot, command, person.by)
        robots = sorted(self._watch.robots) if robot == ALL else [robot]
        orders = [(name, order_of(command, fields, self._watch.keys.of(name), person.by)) for name in robots]
        self._known[id] = one
        while len(self._known) > MAX_REMEMBERED:
            self._known.popitem(last=False)
        self._begin(self._follow(one, orders))
        return one

    def _begin(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _follow(self, one: PageCommand, orders: list[tuple[str, Order]]) -> None:
        if not orders:
            one.become(UNSENT, self._watch.link.trouble or "no robot is known")
        elif len(orders) == 1:
            await self._one(one, *orders[0])
        else:
            await self._all(one, orders)
        self._streams.tell(one.block())

    async def _all(self, one: PageCommand, orders: list[tuple[str, Order]]) -> None:
        """Send a command to several robots. It counts as sent or finished when all have that state.

        In its answer, `robots` has each robot's result.
        """
        each = [PageCommand(one.id, name, one.command, one.by) for name, _ in orders]
        for part, (name, order) in zip(each, orders, strict=True):
            self._begin(self._one(part, name, order))
        for part in each:
            await part.sent.wait()
        if not any(part.state == UNSENT for part in each):
            one.become(SENT)
        for part in each:
            await part.over.wait()
        one.more["robots"] = {part.robot: part.to_json() for part in each}
        worst = next((p for state in (UNSENT, FAILED) for p in each if p.state == state), None)
        one.become(worst.state if worst else FINISHED, f"{worst.robot}: {worst.reason}" if worst else "")

    async def _one(self, one: PageCommand, robot: str, order: Order) -> None:
        rests = one.command == REST
        ttl = REST_TTL if rests else SENT_TIMEOUT
        view = self._watch.robots.get(robot)
        try:
            with self._watch.exchanges.send(order.key, order.body, ttl=ttl, by=one.by, echo=True) as exchange:
                if not await exchange.taken(SENT_TIMEOUT):
                    one.become(UNSENT, self._unsent(exchange, order.key))
                    if rests:
                        self._stop_behavior(robot)
                    return
                one.become(SENT)
                self._streams.tell(one.block())
                if order.note:
                    self._note(robot, order.note, one.by)
                timeout = STOP_TIMEOUT if rests else order.timeout
                async with asyncio.timeout(timeout):
                    if rests:
                        await self._robot_answers(exchange, view)
                    while (reason := order.outcome(answer := await exchange.answer(timeout))) is None:
                        pass
                one.become(FAILED if reason else FINISHED, reason)
                if isinstance(answer, dict):
                    one.more["answer"] = answer
        except (BusError, TimeoutError) as error:
            if one.state != SENT:
                one.become(UNSENT, str(error))
            else:
                one.become(FAILED, no_robot(order.key) if rests else f"no answer came on `{order.key}`")
            if rests:
                self._stop_behavior(robot)

    async def _robot_answers(self, exchange: Exchange, view: KnownRobot | None) -> None:
        """Wait for an answer. Raises BusUnreachableError if the robot's process has ended."""
        sent = time.monotonic()
        while exchange.answers.empty():
            if view and view.lacks(ROBOT_PART) and time.monotonic() - sent > PRESENCE_PATIENCE:
                raise BusUnreachableError("the robot's process has ended")
            await asyncio.sleep(LOOK_PERIOD)

    def _unsent(self, exchange: Exchange, key: str) -> str:
        if exchange.nobody.is_set():
            return f"no process accepts this command (`{key}`)"
        return (
            self._watch.link.trouble
            or "the bus does not accept it: the broker is not connected, or the exhibition hangs"
        )

    def _note(self, robot: str, text: str, by: str) -> None:
        """Write a note with the sender's name into the journal, for a command that bypasses the behaviour."""
        if bus := self._watch.link.bus:
            with suppress(BusError):
                bus.publish(self._watch.keys.of(robot).operator, NOTE(text=text, by=by))

    def _stop_behavior(self, robot: str) -> None:
        """Report the stop to the behaviour in place of the robot, which did not answer."""
        if bus := self._watch.link.bus:
            stop_behavior(bus, robot)
