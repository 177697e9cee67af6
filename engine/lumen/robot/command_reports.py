"""Reports on the states of commands from the bus: to the sender and all subscribers, and again on request."""

from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.ports import Message

ACCEPTED, STARTED, FINISHED, FAILED, CANCELLED = "accepted", "started", "finished", "failed", "cancelled"
UNKNOWN_COMMAND = "unknown"
FINAL = (FINISHED, FAILED, CANCELLED)
MAX_REMEMBERED_COMMANDS = 1_000
"""The number of commands with ids that are remembered, in case a sender repeats one."""

_ANSWERS = {"done": FINISHED, "error": FAILED, "cancelled": CANCELLED}


@dataclass(eq=False)
class CommandRecord:
    """A command from the bus."""

    asker: Message
    """The message with the command, or the last query about the command."""
    id: str = ""
    """The id from its sender; empty if the sender gave none, like the modules of 2015."""
    method: str = ""
    """The method in the command's body, in lower case; empty if unknown."""
    at: str = ""
    """The id under which the robot has the command; empty until the robot has it."""
    state: str = ""
    """The last reported state, one of the constants above; empty before the first report."""
    reason: str = ""
    """Why the command failed, or which joint missed its goal; else empty."""
    result: Mapping[str, Any] | None = None
    """The result of a verb of a feature; None if the verb has no result."""
    parts: frozenset[str] = frozenset()
    """The parts of the body that the command owns."""
    takes: float = 0.0
    """The estimated duration of the command [s]."""
    body: Any = None
    """The body of the command's message; None if only the id is known."""

    @property
    def over(self) -> bool:
        return self.state in FINAL

    @property
    def known_as(self) -> str:
        """The id under which the command is reported."""
        return self.id or self.asker.correlation_id or self.at

    def report(self) -> dict[str, Any]:
        """Return the body of a report on `avatar.ROBOT.event.command`."""
        body = {"id": self.known_as, "state": self.state, "method": self.method}
        news = {"reason": self.reason or None, "result": self.result}
        return {**body, **{name: value for name, value in news.items() if value is not None}}

    def text(self) -> str:
        """Return the final answer in the format of the modules of 2015."""
        return f"command failed: {self.reason}" if self.state == FAILED else f"command {self.state}"


class CommandReports:
    """Remembers the records of commands, and reports each change of a record.

    `tell` publishes a report. `reply` answers the sender: with each report if the sender gave the command an id,
    otherwise once at the end, with the text of 2015.
    """

    def __init__(self, tell: Callable[[dict[str, Any]], None], reply: Callable[[Message, Any], None]) -> None:
        self._tell, self._reply = tell, reply
        self._known: OrderedDict[tuple[str | None, str], CommandRecord] = OrderedDict()
        self._running: dict[str, CommandRecord] = {}

    @property
    def running(self) -> int:
        """The number of accepted commands that are not over: under way, or waiting for parts of the body."""
        return len(self._running)

    def ahead(self, parts: frozenset[str]) -> float:
        """Return the estimated total duration of the open commands that need any of these parts of the body [s]."""
        return sum(record.takes for record in self._running.values() if not parts.isdisjoint(record.parts))

    def find(self, id: str, sender: str) -> CommandRecord | None:
        """Return the record of the command with that id from this or an unknown sender; None without such a record."""
        return self._known.get((sender, id)) or self._known.get((None, id))

    def asked(self, id: str, sender: str) -> CommandRecord | None:
        """Return the record that `sender` means by an id: its own command's, else the newest with that id.

        Return None if no command has that id.
        """
        others = (record for record in reversed(self._known.values()) if record.id == id)
        return self.find(id, sender) or next(others, None)

    def remember(self, record: CommandRecord, sender: str | None) -> None:
        """Remember a command, to report on it if `sender` sends it again; None stands for any sender."""
        if record.id:
            self._known[sender, record.id] = record
            if len(self._known) > MAX_REMEMBERED_COMMANDS:
                self._known.pop(next((key for key, old in self._known.items() if old.over), next(iter(self._known))))

    def accept(self, record: CommandRecord) -> None:
        """Report that the robot has accepted a command, under the id `at` of its record."""
        self._running[record.at] = record
        self.change(record, ACCEPTED)

    def begun(self, at: str) -> None:
        if (record := self._running.get(at)) and record.state == ACCEPTED:
            self.change(record, STARTED)

    def answered(self, kind: str, at: str, reason: str, result: Mapping[str, Any] | None = None) -> bool:
        """Report the robot's `done`, `error` or `cancelled`; return whether it is for a command from the bus.

        The reason of `done` names the joint that missed its goal; `result` is that of a verb of a feature.
        """
        record = self._running.pop(at, None)
        if record is None or kind not in _ANSWERS:
            return False
        if record.state == ACCEPTED and kind == "done":
            self.change(record, STARTED)
        record.result = result
        self.change(record, _ANSWERS[kind], "" if kind == "cancelled" else reason)
        return True

    def change(self, record: CommandRecord, state: str, reason: str = "") -> None:
        record.state, record.reason = state, reason
        self.repeat(record, record.asker)

    def repeat(self, record: CommandRecord, asker: Message) -> None:
        """Report the present state of a command again, to the subscribers and to the sender of this message."""
        record.asker = asker
        self._tell(record.report())
        if record.id:
            self._reply(asker, record.report())
        elif record.over:
            self._reply(asker, record.text())

    def end(self) -> None:
        """Report all running commands as cancelled, because the robot accepts no more."""
        for record in self._running.values():
            self.change(record, CANCELLED)
        self._running.clear()
