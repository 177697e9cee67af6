"""All robots on a bus, with periodic requests for each exhibition's status and new journal entries."""

import asyncio
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import BusError, BusUnreachableError
from lumen.features.console.bus_link import BusLink
from lumen.features.console.entry_clock import ToldPage
from lumen.features.console.entry_ring import KEPT
from lumen.features.console.exchanges import Exchanges
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.robot_keys import PRESENCE, KeyBook
from lumen.language.operator_requests import JOURNAL, NOW, STATUS
from lumen.language.routing_keys import DEFAULT_ALIASES
from lumen.ports import Message
from lumen.project.home import home_of
from lumen.run.reaching import Reached


class Changes:
    """Counts changes, and wakes the callers of `wait` after each."""

    def __init__(self) -> None:
        self.count = 0
        self._next = asyncio.Event()

    def tell(self) -> None:
        """Count a change and wake all callers of `wait`. Call it in the event loop."""
        self.count += 1
        self._next.set()
        self._next = asyncio.Event()

    async def wait(self, seen: int, timeout: float) -> bool:
        """Return True once the count differs from `seen`, False after `timeout` [s]."""
        if self.count != seen:
            return True
        try:
            await asyncio.wait_for(self._next.wait(), timeout)
        except TimeoutError:
            return False
        return True


PERIOD = 0.25
"""The time between two requests to an exhibition while a page is open [s]."""
IDLE_PERIOD = 1.0
"""The time between two requests to an exhibition while no page is open [s]."""
SENSES_PERIOD = 1.0
"""The time between two updates of the shown senses [s]."""
FILES_PERIOD = 3.0
"""The time between two requests about an exhibition's files [s]."""
QUESTION_TIMEOUT = 2.0
MAX_ROBOTS = 50
FULL_PAGE = 100
"""After a page with at least this many entries, the next one is requested without a pause."""


class Watch:
    """The robots on a bus, by name; `changes` counts their changes.

    Call all methods in the console's event loop. `reach` opens the bus of the project in `root`.
    """

    def __init__(self, reach: Callable[[], Reached], root: Path) -> None:
        self.changes, self.keys = Changes(), KeyBook(root)
        self.robots: dict[str, KnownRobot] = {}
        self.lookers = 0
        """The number of open streams of pages."""
        self.felt: Callable[[str, str, Mapping[str, Any]], None] = lambda _robot, _sense, _body: None
        """Called with the robot, sense and body of each message of a sense, on a thread of the bus."""
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._news = set[str]()
        self.link = BusLink(
            _without_path(reach, root), self._patterns, heard=self._heard, answered=self._answered,
            returned=self._returned, changed=lambda: self._later(self._link_changed),
        )  # fmt: skip
        self.exchanges = Exchanges(self.link)

    def start(self) -> None:
        self._loop = asyncio.get_running_loop()
        for robot in self.keys.robots:  # even before they answer, because their journals can be read without them
            self._know(robot)
        self.link.start()

    async def close(self) -> None:
        for task in self._tasks.values():
            task.cancel()
        await asyncio.to_thread(self.link.close)

    def _later(self, call: Callable[..., object], *arguments: Any) -> None:
        """Schedule a call in the console's event loop. Any thread may call this."""
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(call, *arguments)

    def _patterns(self, reached: Reached) -> Any:
        patterns = self.keys.use(reached)
        for robot in self.keys.robots:
            self._later(self._know, robot)
        return patterns

    def _answered(self, message: Message) -> None:
        if self.exchanges.ours(message):
            self._later(self.exchanges.take, message)

    def _returned(self, key: str) -> None:
        self._later(self.exchanges.nobody_takes, key)

    def _heard(self, message: Message) -> None:
        """Handle a message about a sense, a presence or the files' status. Called on a thread of the bus."""
        body = message.body
        if not isinstance(body, Mapping):
            return
        robot, sense = self.keys.sense(message.key)
        if sense == PRESENCE or message.key == DEFAULT_ALIASES[PRESENCE] or message.key.endswith(f".{PRESENCE}"):
            if isinstance(body.get("robot"), str) and isinstance(body.get("parts"), list):
                self._later(self._present, body)
        elif sense and robot in self.robots:
            with suppress(KeyError):  # on a thread of the bus: the robots may change meanwhile
                self.robots[robot].feel(sense, body)
                self.felt(robot, sense, body)
        elif message.key.endswith("config.status"):
            self._later(self._files_changed)

    def _present(self, body: Mapping[str, Any]) -> None:
        if view := self._know(str(body["robot"])[:60]):
            before = view.version
            view.present(body)
            if view.version != before:
                self.changes.tell()

    def _files_changed(self) -> None:
        self._news |= set(self.robots)

    def _link_changed(self) -> None:
        for view in self.robots.values():
            view.look(self.link.up)
        self.changes.tell()

    def _know(self, robot: str) -> KnownRobot | None:
        """Return the view of a robot, and start watching a new robot; None if there are MAX_ROBOTS already."""
        if robot not in self.robots and len(self.robots) < MAX_ROBOTS:
            self.robots[robot] = KnownRobot(robot)
            self._tasks[robot] = self._loop.create_task(self._watch(self.robots[robot]))
        return self.robots.get(robot)

    async def _watch(self, view: KnownRobot) -> None:
        sensed = asked = 0.0
        while True:
            before, more = (view.version, view.entries.last), False
            now = time.monotonic()
            if self.link.up:
                with suppress(BusError):
                    more = await self._request(view)
                    if now - asked > FILES_PERIOD or view.robot in self._news:
                        self._news.discard(view.robot)
                        asked = now
                        await self._ask_files(view)
            if now - sensed >= SENSES_PERIOD or not view.connected:
                sensed = now
                view.look(self.link.up)
            if (view.version, view.entries.last) != before:
                self.changes.tell()
            if not more:
                await asyncio.sleep(PERIOD if self.lookers else IDLE_PERIOD)

    async def _request(self, view: KnownRobot) -> bool:
        """Request a robot's status and its new entries; return True if there are more entries."""
        keys = self.keys.of(view.robot)
        said = await self.exchanges.request(keys.operator, NOW(), QUESTION_TIMEOUT)
        if not isinstance(said, dict) or "robot" not in said:  # an older Lumen
            said = await self.exchanges.request(keys.operator, STATUS(), QUESTION_TIMEOUT)
        if not isinstance(said, dict):
            return False
        view.answered(said)
        entries, position = view.entries, view.position
        if position is None and "position" in view.said:
            return False
        if not entries.known or (position is not None and position < entries.last):
            entries.begin(max(-1, (position or 0) - KEPT))
        if position is not None and position <= entries.last:
            return False
        return entries.add(await self.page(view.robot, entries.last + 1)) >= FULL_PAGE

    async def page(self, robot: str, begin: int) -> ToldPage:
        """Return the page of a robot's journal from a position on. Raises BusError if no exhibition answers."""
        question = JOURNAL(**{"from": begin})
        said = await self.exchanges.request(self.keys.of(robot).operator, question, QUESTION_TIMEOUT)
        said = said if isinstance(said, dict) else {}
        entries, epoch = said.get("entries"), said.get("epoch")
        return ToldPage(
            [one for one in entries or () if isinstance(one, dict) and type(one.get("position")) is int],
            float(epoch) if isinstance(epoch, int | float) else None,
        )

    async def _ask_files(self, view: KnownRobot) -> None:
        said = await self.exchanges.request(self.keys.of(view.robot).config, {"command": "status"}, QUESTION_TIMEOUT)
        if isinstance(said, dict):
            view.told(said)


def _without_path(reach: Callable[[], Reached], root: Path) -> Callable[[], Reached]:
    """Return `reach` with the project's path removed from its errors, because every page shows them."""

    def reached() -> Reached:
        try:
            return reach()
        except BusError as error:
            text = str(error)
            for path in (home_of(root).absolute(), root.absolute(), root.resolve()):
                text = text.replace(str(path), "this project")
            raise BusUnreachableError(text) from None

    return reached
