"""The sleep of a loop between two ticks."""

from collections.abc import Iterator
from contextlib import contextmanager

from lumen.ports import Dozes


class Nap:
    """A sleep in which nothing is due, and which `end` cuts short from any thread."""

    def __init__(self) -> None:
        self._clock: Dozes | None = None

    @contextmanager
    def on(self, clock: Dozes | None) -> Iterator[None]:
        """Nap on a clock, if it dozes. Begin before you look what is due: a message that comes later ends the nap."""
        self._clock = clock
        try:
            yield
        finally:
            self._clock = None

    def end(self) -> None:
        """Let the nap end, if there is one."""
        if clock := self._clock:
            clock.hurry()
