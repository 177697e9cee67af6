"""Print a run on a terminal, a line for each event: its time, its actor, and its cause."""

import shutil
import sys
import textwrap
from collections.abc import Callable
from typing import TextIO

from lumen.cli.streams import hush
from lumen.cli.terminal import coloured, paint
from lumen.language.machines import MachineDefinition
from lumen.run.narrator import Narrator

INDENT = 18

WHO = {"visitor": "yellow", "robot": "cyan", "state": "green", "reload": "magenta", "trouble": "red"}


class Transcript(Narrator):
    """Prints one line for each event, with the exhibition's time, and with the robot's name if `robot` is not empty.

    `unread` is called if the reader of a pipe has gone.
    """

    explains = True

    def __init__(
        self,
        now: Callable[[], float],
        machine: Callable[[], MachineDefinition],
        stream: TextIO | None = None,
        robot: str = "",
        unread: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(now, machine)
        self._stream = stream or sys.stdout
        self._robot = f"{robot} " if robot else ""
        self._unread = unread
        self._colour = coloured(self._stream)

    def line(self, who: str, text: str) -> None:
        """Print a line with the time, the actor (`who`, a key of WHO or another word), and the event (`text`)."""
        minutes, tenths = divmod(int(self._now() * 10 + 1e-6), 600)
        time = paint(f"{minutes:2d}:{tenths / 10:04.1f}", "dim", on=self._colour)
        name = paint(f"{who:<8}", WHO.get(who, "dim"), on=self._colour)
        self.note(f"{time}  {self._robot}{name} {_wrapped(text, INDENT + len(self._robot))}")

    def note(self, text: str) -> None:
        """Print a text unchanged; discard it if the stream can't be written."""
        try:
            print(text, file=self._stream, flush=True)
        except OSError as error:  # the show continues if its log is full, and ends in order if the reader is gone
            hush(self._stream)
            if isinstance(error, BrokenPipeError):
                self._unread()


def _wrapped(text: str, indent: int) -> str:
    """Return the text wrapped to the terminal's width, with further lines indented by `indent` columns.

    Characters that could control the terminal are replaced.
    """
    text = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
    width = max(shutil.get_terminal_size((120, 24)).columns - indent, 30)
    lines = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)
    return ("\n" + " " * indent).join(lines)
