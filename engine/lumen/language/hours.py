"""Times of day in the YAML: `at: {"mon-fri 18:00": closing}`."""

from dataclasses import dataclass, field
from datetime import date

WEEKDAYS = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
"""The results of `weekday()`, in the order of `date.weekday`."""


@dataclass(frozen=True, slots=True)
class Schedule:
    """Moments by the wall clock: each of `times` on each of the days."""

    times: tuple[int, ...]
    """The times of day, in minutes since midnight."""
    weekdays: tuple[int, ...] = ()
    """Days of the week, 0 being Monday."""
    dates: tuple[date, ...] = ()
    """Days of the calendar. Without `weekdays` and `dates`, the schedule applies to every day."""
    text: str = field(default="", compare=False)
    """The schedule as the author wrote it."""

    def holds(self, day: date) -> bool:
        """Return True if the schedule applies to that day."""
        return not (self.weekdays or self.dates) or day.weekday() in self.weekdays or day in self.dates
