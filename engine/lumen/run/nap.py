"""The sleep of a loop between two ticks."""

from collections.abc import Iterator
from contextlib import contextmanager

from lumen.ports import Dozes


class Nap:
    """A sleep while nothing is due; `end` cuts it short from any thread."""

    def __init__(self) -> None:
        self._clock: Dozes | None = None

    @contextmanager
    def on(self, clock: Dozes | None) -> Iterator[None]:
        """Enable naps on a clock; None, for a clock that can't doze, disables them.

        Enter this before you check what is due, so that a message that arrives later ends the nap.
        """
        self._clock = clock
        try:
            yield
        finally:
            self._clock = None

    def end(self) -> None:
        """End the nap, if one is enabled."""
        if clock := self._clock:
            clock.hurry()
