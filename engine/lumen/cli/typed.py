"""What is typed on the terminal is what the visitor says."""

import queue
import sys
import threading
from collections.abc import Callable
from io import TextIOWrapper

from lumen.language.stories import Leave, Speak, VisitorAction
from lumen.runtime.visitor import VisitorActor


class TypedSpeech:
    """Reads lines on a thread of its own; at the end of input the visitor walks away.

    Where there is no terminal and nothing ever comes, nobody types: the visitor stays, and the show goes on.
    """

    def __init__(self, walker: VisitorActor, tell: Callable[[VisitorAction], None]) -> None:
        self._walker, self._tell = walker, tell
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._gone: float | None = None
        threading.Thread(target=self._read, name="lumen-typing", daemon=True).start()

    def tick(self, now: float) -> None:
        """Say what was typed since the last tick."""
        while not self._lines.empty():
            line = self._lines.get()
            if line is None:
                self._tell(Leave())
                self._walker.leave()
                self._gone = now
            elif line:
                self._tell(Speak(line))
                self._walker.speak(line)

    def gone_for(self, now: float) -> float:
        """How long ago the visitor left [s]."""
        return 0.0 if self._gone is None else now - self._gone

    def _read(self) -> None:
        if isinstance(sys.stdin, TextIOWrapper):
            sys.stdin.reconfigure(errors="replace")
        typed = sys.stdin is not None and sys.stdin.isatty()
        for line in sys.stdin or ():
            typed = True
            self._lines.put(line.strip())
        if typed:
            self._lines.put(None)
