"""The time of day in a story, which begins at the time that the story sets, on any real day."""

from datetime import date
from functools import cache

from lumen.expressions.wall_clock import MICROSECONDS, moment, next_moment
from lumen.language.hours import Schedule
from lumen.language.stories import Story

MORNING = Schedule((10 * 60,))
"""The time of day at which a story begins by default."""

MONDAY = date(2026, 6, 1)
"""The date on which a story begins by default; a story with a weekday begins in this week."""


def story_epoch(story: Story | None, timezone: str) -> float:
    """Return when a story begins by the clock in a time zone [s since 1970]; without a story, the default time."""
    return _epoch((story and story.clock) or MORNING, timezone)


@cache  # a story asks in each tick
def _epoch(begins: Schedule, timezone: str) -> float:
    midnight = Schedule((0,), dates=(min(begins.dates, default=MONDAY),))
    first = next_moment(midnight, moment(-1e10, 0.0), timezone)
    found = next_moment(begins, (first or 0) - 1, timezone)
    return (found or 0) / MICROSECONDS


def story_moment(story: Story, timezone: str, lived: float) -> int:
    """Return the moment by the story's clock after `lived` [s] of the story, in microseconds."""
    return moment(story_epoch(story, timezone), lived)
