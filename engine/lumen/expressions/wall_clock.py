"""The wall clock: the local time of a moment in a time zone, and the next occurrence of a time of day.

A moment is an integer [µs since 1970, UTC]: it is exact, and finer than a time of day needs. The rules of time zones
are those of `zoneinfo`.
"""

from datetime import UTC, date, datetime, time, timedelta, tzinfo
from datetime import timezone as fixed_zone
from functools import lru_cache
from re import fullmatch
from zoneinfo import ZoneInfo

from lumen.errors import UsageError
from lumen.language.hours import Schedule
from lumen.language.nanoseconds import nanoseconds

MICROSECONDS = 1_000_000
"""Microseconds per second."""

_ZERO = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND, _SECOND = timedelta(microseconds=1), timedelta(seconds=1)
_FIRST, _LAST = ((datetime(year, 1, 1, tzinfo=UTC) - _ZERO) // _MICROSECOND for year in (2, 9998))
"""The range of moments in which time zones are defined."""

_WEEK = 8
"""The number of days, including today, after which each time on each weekday has occurred."""


@lru_cache(maxsize=64)
def zone(name: str) -> tzinfo:
    """Return the time zone of an IANA name or of `UTC+02:00`; UTC for an empty name; raise UsageError for others."""
    if not name:
        return UTC
    if fixed := fullmatch(r"UTC([+-])([01]\d|2[0-3]):([0-5]\d)", name):
        east = timedelta(hours=int(fixed[2]), minutes=int(fixed[3]))
        return fixed_zone(east if fixed[1] == "+" else -east)
    try:
        return ZoneInfo(name)
    except (KeyError, ValueError, OSError):  # KeyError: unknown; OSError: the name of a folder
        raise UsageError(f"there is no time zone `{name[:60]}`: write one such as `Europe/Berlin`") from None


def moment(epoch: float, at: float) -> int:
    """Return the moment at which a clock shows `at` [s] if its zero was at `epoch` [s since 1970, UTC].

    A moment beyond the range of time zones becomes the nearest one within it.
    """
    shown = (nanoseconds(epoch) + nanoseconds(at) + 500) // 1000
    return min(max(shown, _FIRST), _LAST)


def local_time(moment: int, timezone: str) -> datetime:
    """Return the local date and time of a moment."""
    return (_ZERO + moment * _MICROSECOND).astimezone(zone(timezone))


def next_moment(schedule: Schedule, after: int, timezone: str) -> int | None:
    """Return the first moment of a schedule that is later than `after`; None if the schedule is over.

    A time of day occurs when the wall clock first shows this time or a later one. A time that is skipped in spring
    occurs at the end of the gap; a time that is repeated in autumn occurs only the first time.
    """
    region = zone(timezone)
    today = local_time(after, timezone).date()
    for day in _days(schedule, today):
        for minute in schedule.times:
            found = _first(datetime.combine(day, time(*divmod(minute, 60))), region)
            if found > after:
                return found
    return None


def readjusted(due: int, schedule: Schedule, was: int, now: int, timezone: str) -> int | None:
    """Return the next moment of a schedule after the clock was set from `was` to `now`; None if the schedule is over.

    `due` was the next moment before. After a correction of up to an hour, the result is `due`. After a greater
    correction, it is the next moment from `now`; if the clock was put forward, it is the next one from the midnight
    before `now` or from `was`, whichever is later, and a moment that has passed today is due at once.
    """
    if abs(now - was) <= 3600 * MICROSECONDS:
        return due
    if now < was:
        return next_moment(schedule, now, timezone)
    midnight = _first(datetime.combine(local_time(now, timezone).date(), time()), zone(timezone))
    return next_moment(schedule, max(was, midnight - 1), timezone)


def _days(schedule: Schedule, today: date) -> list[date]:
    """Return the days on which a schedule may occur next, in order."""
    soon = (today + timedelta(days=i) for i in range(_WEEK))
    return sorted({day for day in soon if schedule.holds(day)}.union(day for day in schedule.dates if day >= today))


def _first(wanted: datetime, region: tzinfo) -> int:
    """Return the moment at which the wall clock first shows a local time, or skips it."""
    late = wanted.replace(tzinfo=region).astimezone(UTC)
    if late.astimezone(region).replace(tzinfo=None) != wanted:  # skipped: `fold` selects the offset
        early = wanted.replace(tzinfo=region, fold=1).astimezone(UTC)
        while late - early > _SECOND:
            middle = early + (late - early) // 2 // _SECOND * _SECOND
            if middle.astimezone(region).replace(tzinfo=None) < wanted:
                early = middle
            else:
                late = middle
    return (late - _ZERO) // _MICROSECOND
