"""Commands that come from outside of the behaviour: told, and kept in the journal."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.app.narrator import Narrator
from lumen.language.commands import Say
from lumen.language.events import Event
from lumen.language.verbs import verb_of
from lumen.ports import Aim, Live, Perform, Record, RobotCommand

WHO = "command"


class ForeignCommands:
    """Hears what a robot is given over the bus, and what it refuses; `is_brains` says of an id whether it is ours.

    `record` keeps an entry of the journal.
    """

    def __init__(
        self,
        narrator: Narrator,
        *,
        is_brains: Callable[[str], bool] = lambda _: False,
        record: Callable[[Mapping[str, Any]], None] = lambda _: None,
    ) -> None:
        self._narrator, self._is_brains, self._record = narrator, is_brains, record

    def given(self, command: RobotCommand, id: str) -> None:
        """The robot begins it."""
        if isinstance(command, Aim) or self._is_brains(id):
            return
        self._narrator.line(WHO, words(command))
        self._record({"command": words(command), "id": id})

    def refused(self, method: str, reason: str) -> None:
        """The robot does not."""
        self._narrator.line(WHO, f"refused: {method or 'a command'}, for {reason}")
        self._record({"command": method, "refused": reason})

    def noticed(self, event: Event) -> None:
        """A person stopped the robot, or let it move again."""
        by = event.data.get("by", "") if isinstance(event.data, dict) else ""
        self._narrator.line("operator", f"{event.name}, by {by}")
        self._record({event.name: by})


def words(command: RobotCommand) -> str:
    """What a robot does by a command, as the transcript has it."""
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
