"""No robot at all: the behaviour runs, but every command is refused."""

from collections.abc import Sequence

from lumen.language.events import Event
from lumen.ports import Aim, Live, Reading, RobotCommand, Sense


class NoRobot:
    """Answers every command with an error, except aims and life styles, which have no answer; senses nothing."""

    def __init__(self) -> None:
        self._answers: list[Event] = []

    def start(self, id: str, command: RobotCommand) -> None:
        if not isinstance(command, Aim | Live):
            self._answers.append(Event(f"error.command.{id}", {"reason": "there is no robot (--robot none)"}))

    def cancel(self, id: str) -> None:
        """Do nothing, because no command runs."""

    def poll(self) -> Sequence[Event]:
        answers, self._answers = self._answers, []
        return answers

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        return None

    def close(self) -> None:
        """Do nothing: there are no resources to release."""
