"""Times of day as the YAML says them: `at: {"mon-fri 18:00": closing}`."""

from dataclasses import dataclass, field
from datetime import date

WEEKDAYS = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
"""As `weekday()` says them; their places are those of `date.weekday`."""


@dataclass(frozen=True, slots=True)
class Schedule:
    """Moments by the clock on the wall: each of `times` [min since midnight] on each of the days.

    The days are those of `weekdays` (0 is Monday) and `dates`; every day where both are empty. `text` is how it is
    written.
    """

    times: tuple[int, ...]
    weekdays: tuple[int, ...] = ()
    dates: tuple[date, ...] = ()
    text: str = field(default="", compare=False)

    def holds(self, day: date) -> bool:
        """Return True if that is one of its days."""
        return not (self.weekdays or self.dates) or day.weekday() in self.weekdays or day in self.dates
