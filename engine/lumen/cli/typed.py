"""A visitor played by the person at the terminal: lines are speech, and lines that begin with `/` are commands."""

import queue
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import TextIOWrapper

from lumen.cli.typed_commands import TypedCommands
from lumen.language.events import Event
from lumen.language.stories import Arrive, Leave, Speak, Visitor
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.parts.visitor import VisitorPart
from lumen.run.services import Services
from lumen.upkeep.threads import WatchedThread

FAREWELL = 5.0
"""The time that the exhibition continues after the visitor has left [s]."""
MAX_LINE_CHARACTERS = 1_000
"""The maximum length of a line; a longer line is split."""
MAX_WAITING_LINES = 100
"""The maximum number of lines that wait to be spoken; reading pauses until a line was spoken."""


def typed_visitor(services: Services) -> "TypedVisitorPart | None":
    """Return the part for a typed visitor; None if the exhibition has no visitor, or if a story plays the visitor."""
    visitor = services.get(VisitorPart)
    if visitor is None or services.plan.story:
        return None
    return TypedVisitorPart(visitor, services.narrator, services.plan.options["greeting"], services.nap.end)


class TypedVisitorPart(Part):
    """Reads lines on its own thread, and makes the visitor speak or perform them; the visitor leaves at end of input.

    If standard input is not a terminal and yields no line, the visitor stays and the exhibition continues. `greeting`
    is printed first. `wake` is called for each line, on the reading thread.
    """

    patient = True

    def __init__(self, visitor: VisitorPart, narrator: Narrator, greeting: str, wake: Callable[[], None]) -> None:
        self.needs, self._wake = visitor.needs, wake
        self._visitor, self._narrator, self._greeting = visitor.actor, narrator, greeting
        self._commands = TypedCommands(visitor.actor, narrator, visitor.environment)
        self._lines: queue.Queue[str | None] = queue.Queue(MAX_WAITING_LINES)
        self._gone: float | None = None
        self._now = 0.0
        self._thread = WatchedThread("lumen-typing", self._read)

    @property
    def over(self) -> bool:
        """True if the visitor left more than FAREWELL seconds ago."""
        return self._gone is not None and self._now - self._gone > FAREWELL

    def begin(self, now: float) -> None:
        """Greet the person, let the visitor arrive, and start to read."""
        self._narrator.note(self._greeting)
        self._visitor.arrive(Visitor())
        self._narrator.visitor_action(Arrive(Visitor()))
        self._thread.start()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Speak the lines, and perform the commands, that were typed since the last tick."""
        self._now = now
        for _ in range(self._lines.qsize()):
            line = self._lines.get()
            if line is None:
                self._narrator.visitor_action(Leave())
                self._visitor.leave()
                self._gone = now
            elif line.startswith("/"):
                self._commands.do(line, now)
            elif line:
                self._narrator.visitor_action(Speak(line))
                self._visitor.speak(line)
        self._commands.tick(now)

    def _read(self) -> None:
        if isinstance(sys.stdin, TextIOWrapper):
            sys.stdin.reconfigure(errors="replace")
        typed = sys.stdin is not None and sys.stdin.isatty()
        with suppress(OSError):  # such as a terminal that was closed: nothing more can be typed
            while sys.stdin and (line := sys.stdin.readline(MAX_LINE_CHARACTERS)):
                typed = True
                self._lines.put(line.strip())
                self._wake()
        if typed:
            self._lines.put(None)
