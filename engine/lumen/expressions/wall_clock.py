"""The clock on the wall: which local time a moment has in a time zone, and when a time of day comes next.

A moment is a whole number of [µs] since 1970 began in UTC: exact, and finer than anybody asks of a time of day. The
rules of time zones are those of `zoneinfo`.
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
"""In a second."""

_ZERO = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND, _SECOND = timedelta(microseconds=1), timedelta(seconds=1)
_FIRST, _LAST = ((datetime(year, 1, 1, tzinfo=UTC) - _ZERO) // _MICROSECOND for year in (2, 9998))
"""Before and after these no time zone can be asked."""

_WEEK = 8
"""Within so many days, today included, each time of each weekday comes again."""


@lru_cache(maxsize=64)
def zone(name: str) -> tzinfo:
    """The time zone of an IANA name, or `UTC+02:00`; UTC for an empty one. Raises UsageError for any other."""
    if not name:
        return UTC
    if fixed := fullmatch(r"UTC([+-])([01]\d|2[0-3]):([0-5]\d)", name):
        east = timedelta(hours=int(fixed[2]), minutes=int(fixed[3]))
        return fixed_zone(east if fixed[1] == "+" else -east)
    try:
        return ZoneInfo(name)
    except (KeyError, ValueError, OSError):  # KeyError is ZoneInfoNotFoundError's; a folder's name is an OSError
        raise UsageError(f"there is no time zone `{name[:60]}`: write one such as `Europe/Berlin`") from None


def moment(epoch: float, at: float) -> int:
    """The moment at which a clock shows `at` [s] whose zero was at `epoch` [s since 1970]."""
    shown = (nanoseconds(epoch) + nanoseconds(at) + 500) // 1000
    return min(max(shown, _FIRST), _LAST)


def local_time(moment: int, timezone: str) -> datetime:
    """What calendar and clock show then."""
    return (_ZERO + moment * _MICROSECOND).astimezone(zone(timezone))


def next_moment(schedule: Schedule, after: int, timezone: str) -> int | None:
    """The first moment of a schedule that is later than `after`; None where there is none.

    A time of day comes when the clock on the wall first shows it or a later one: one that spring skips at the moment
    after the gap, one that autumn repeats once.
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
    """When a schedule comes that was waited for until `due`, where the clock was set from `was` to `now`.

    Where it was off by no more than an hour, when it would have come. After more the wait begins anew: from `now`, or,
    if that is later than it was, from the midnight before; what has passed today is due at once.
    """
    if abs(now - was) <= 3600 * MICROSECONDS:
        return due
    if now < was:
        return next_moment(schedule, now, timezone)
    midnight = _first(datetime.combine(local_time(now, timezone).date(), time()), zone(timezone))
    return next_moment(schedule, max(was, midnight - 1), timezone)


def _days(schedule: Schedule, today: date) -> list[date]:
    """The days on which a schedule may come next, in their order."""
    soon = (today + timedelta(days=i) for i in range(_WEEK))
    return sorted({day for day in soon if schedule.holds(day)}.union(day for day in schedule.dates if day >= today))


def _first(wanted: datetime, region: tzinfo) -> int:
    """The moment at which the clock on the wall first shows this, or jumps over it."""
    late = wanted.replace(tzinfo=region).astimezone(UTC)
    if late.astimezone(region).replace(tzinfo=None) != wanted:  # skipped: `fold` says by which offset it is read
        early = wanted.replace(tzinfo=region, fold=1).astimezone(UTC)
        while late - early > _SECOND:
            middle = early + (late - early) // 2 // _SECOND * _SECOND
            if middle.astimezone(region).replace(tzinfo=None) < wanted:
                early = middle
            else:
                late = middle
    return (late - _ZERO) // _MICROSECOND
