"""The clock on the wall of a story: it begins when the story says, on whatever day it is played."""

from datetime import date

from lumen.expressions.wall_clock import MICROSECONDS, moment, next_moment
from lumen.language.hours import Schedule
from lumen.language.stories import Story

MORNING = Schedule((10 * 60,))
"""The time of day at which a story begins that does not say."""

MONDAY = date(2026, 6, 1)
"""The day on which a story begins that names none; of one that names a day of the week, that of this week."""


def story_epoch(story: Story | None, timezone: str) -> float:
    """When the story begins, by the clock on the wall there [s since 1970]; without one, as one that does not say."""
    begins = (story and story.clock) or MORNING
    midnight = Schedule((0,), dates=(min(begins.dates, default=MONDAY),))
    first = next_moment(midnight, moment(-1e10, 0.0), timezone)
    found = next_moment(begins, (first or 0) - 1, timezone)
    return (found or 0) / MICROSECONDS


def story_moment(story: Story, timezone: str, lived: float) -> int:
    """The moment that the clock on the wall shows when so much of the story has been lived through [s]."""
    return moment(story_epoch(story, timezone), lived)
