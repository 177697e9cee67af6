"""The progress of a film: drawing takes longer than playback, so the remaining time is printed every 15 s."""

import time
from collections.abc import Callable

FILM_TOLD_EVERY = 15.0
"""The minimum real time between two lines [s]."""


class FilmProgress:
    """Calls `tell` with the progress of a film of about `whole` [s]; `whole` is 0 if the length is unknown."""

    def __init__(
        self, tell: Callable[[str], None], whole: float = 0.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._tell, self._whole, self._clock = tell, whole, clock
        self._began = self._told = clock()

    def tick(self, length: float) -> None:
        """Report that `length` [s] are drawn, if a line is due."""
        now = self._clock()
        if now - self._told < FILM_TOLD_EVERY or length <= 0.0:
            return
        self._told, took = now, now - self._began
        left = (self._whole - length) * took / length
        of = f" of about {self._whole:.0f} s are ready; about {_duration(left)} to go" if left > 0.0 else " s"
        self._tell(f"video: {length:.0f}{of}")


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d} min" if minutes else f"{rest} s"
