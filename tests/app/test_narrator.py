"""The lines of a transcript, and the additions by a robot's answer to a command."""

from typing import Any

from lumen.language.commands import BodyCommand, Look, Play, Start
from lumen.language.events import Event
from lumen.run.narrator import Narrator
from lumen.statechart import Machine
from tests.tables import for_each

MACHINE = Machine.from_dict({"states": {"a": None}})


class Lines(Narrator):
    def __init__(self) -> None:
        super().__init__(lambda: 0.0, lambda: MACHINE)
        self.lines: list[tuple[str, str]] = []

    def line(self, who: str, text: str) -> None:
        self.lines.append((who, text))


@for_each(
    "command, answer, data, line",
    [
        (Look(), "done", None, None),
        (Look(), "cancelled", None, ("robot", "ends early: turns its head")),
        (Look(), "error", {"reason": "the motors are off"}, ("trouble", "could not turn its head: the motors are off")),
        (Play("wave"), "done", None, None),
        (Play("wave"), "cancelled", None, ("robot", "ends early: plays wave")),
    ],
)
def test_an_answer_adds_its_line(command: BodyCommand, answer: str, data: Any, line: tuple[str, str] | None) -> None:
    narrator = Lines()
    narrator.performing(Start("c1", command), 0.0)
    narrator.lines.clear()
    narrator.answered(Event(f"{answer}.command.c1", data, 1.0))
    assert narrator.lines == [line] * bool(line)
    assert narrator.played == ({"wave": 1} if (answer, command) == ("done", Play("wave")) else {})
