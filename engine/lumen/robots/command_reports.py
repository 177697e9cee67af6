"""How commands from the bus stand: told to who asked and to everybody who watches, and again to who asks again."""

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumen.ports import Message

ACCEPTED, STARTED, FINISHED, FAILED, CANCELLED = "accepted", "started", "finished", "failed", "cancelled"
UNKNOWN = "unknown"
FINAL = (FINISHED, FAILED, CANCELLED)
MAX_REMEMBERED_COMMANDS = 1_000
"""How many commands with an id of their own are remembered: whoever sends one again is told what became of it."""

_ANSWERS = {"done": FINISHED, "error": FAILED, "cancelled": CANCELLED}


@dataclass(eq=False)
class CommandRecord:
    """A command from the bus, `asker` the message that brought it.

    `id` is the one that its sender gave it, empty where it gave none, as the modules of 2015; `at` is what the robot
    calls it.
    """

    asker: Message
    id: str = ""
    method: str = ""
    at: str = ""
    state: str = ""
    reason: str = ""

    @property
    def over(self) -> bool:
        return self.state in FINAL

    @property
    def known_as(self) -> str:
        """Under which id it is reported."""
        return self.id or self.asker.correlation_id or self.at

    def report(self) -> dict[str, Any]:
        """The body on `avatar.ROBOT.event.command`."""
        body = {"id": self.known_as, "state": self.state, "method": self.method}
        return {**body, "reason": self.reason} if self.reason else body

    def text(self) -> str:
        """What the modules of 2015 are told at the end."""
        return f"command failed: {self.reason}" if self.state == FAILED else f"command {self.state}"


class CommandReports:
    """Remembers errands, and tells of every change of theirs.

    `tell` publishes a report; `reply` answers a message: with the report where it brought an id of its own, else with
    2015's text, at the end.
    """

    def __init__(self, tell: Callable[[dict[str, Any]], None], reply: Callable[[Message, Any], None]) -> None:
        self._tell, self._reply = tell, reply
        self._known: OrderedDict[str, CommandRecord] = OrderedDict()
        self._running: dict[str, CommandRecord] = {}

    @property
    def running(self) -> int:
        """How many are under way, or wait for the parts they need."""
        return len(self._running)

    def find(self, id: str) -> CommandRecord | None:
        """The errand with that id of its sender's."""
        return self._known.get(id)

    def remember(self, errand: CommandRecord) -> None:
        """From now on who sends this again is told how it stands."""
        if errand.id:
            self._known[errand.id] = errand
            if len(self._known) > MAX_REMEMBERED_COMMANDS:
                self._known.pop(next((id for id, old in self._known.items() if old.over), next(iter(self._known))))

    def accept(self, errand: CommandRecord) -> None:
        """The robot has it, under the id `at`."""
        self._running[errand.at] = errand
        self.change(errand, ACCEPTED)

    def begun(self, at: str) -> None:
        if (errand := self._running.get(at)) and errand.state == ACCEPTED:
            self.change(errand, STARTED)

    def answered(self, kind: str, at: str, reason: str) -> bool:
        """The robot said `done`, `error` or `cancelled`; whether it was of one of ours."""
        errand = self._running.pop(at, None)
        if errand is None or kind not in _ANSWERS:
            return False
        if errand.state == ACCEPTED and kind == "done":
            self.change(errand, STARTED)
        self.change(errand, _ANSWERS[kind], reason if kind == "error" else "")
        return True

    def change(self, errand: CommandRecord, state: str, reason: str = "") -> None:
        errand.state, errand.reason = state, reason
        self.repeat(errand, errand.asker)

    def repeat(self, errand: CommandRecord, asker: Message) -> None:
        """Tell how it stands, and this message as well."""
        errand.asker = asker
        self._tell(errand.report())
        if errand.id:
            self._reply(asker, errand.report())
        elif errand.over:
            self._reply(asker, errand.text())

    def end(self) -> None:
        """The robot takes no more commands: what runs counts as cancelled."""
        for errand in self._running.values():
            self.change(errand, CANCELLED)
        self._running.clear()
