"""Commands from outside the behaviour, reported in the transcript and the journal."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.language.commands import Say
from lumen.language.events import Event
from lumen.language.verbs import verb_of
from lumen.ports import Aim, Live, Perform, Record, RobotCommand
from lumen.robot.command_receiver import CommandListener
from lumen.run.narrator import Narrator

WHO = "command"


class ForeignCommands(CommandListener):
    """A listener that reports a robot's commands from the bus, including the refused ones.

    `record` writes an entry of the journal.
    """

    def __init__(self, narrator: Narrator, record: Callable[[Mapping[str, Any]], None] = lambda _: None) -> None:
        self._narrator, self._record = narrator, record

    def given(self, command: RobotCommand, id: str) -> None:
        if isinstance(command, Aim) or self.is_brains(id):
            return
        self._narrator.line(WHO, words(command))
        self._record({"command": words(command), "id": id})

    def refused(self, method: str, reason: str) -> None:
        self._narrator.line(WHO, f"refused: {method or 'a command'}, for {reason}")
        self._record({"command": method, "refused": reason})

    def noticed(self, event: Event) -> None:
        by = event.data.get("by", "") if isinstance(event.data, dict) else ""
        self._narrator.line("operator", f"{event.name}, by {by}")
        self._record({event.name: by})


def words(command: RobotCommand) -> str:
    """Return a command in the words of the transcript."""
    match command:
        case Say(text):
            return f"says “{text}”"
        case Perform(motion):
            return f"plays {motion.name}"
        case Record(name, duration):
            return f"listens for {duration:g} s: {name}"
        case Aim():
            return "aims"
        case Live(style):
            return f"is alive: {style.name}"
        case _:
            return verb_of(command).transcript(command)
