"""The next moment of a time of day, compared with a search that checks every minute."""

from contextlib import suppress
from datetime import UTC, date, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.expressions.wall_clock import MICROSECONDS, local_time, next_moment
from lumen.language.hours import WEEKDAYS, Schedule
from lumen.project.schedules import MisreadTimeError, read_schedule
from tests.tables import for_each

ZONES = (
    "Europe/Berlin", "America/New_York", "Australia/Lord_Howe", "Pacific/Apia", "Asia/Jakarta", "Africa/Casablanca",
    "America/Sao_Paulo", "Asia/Tehran", "Pacific/Chatham", "UTC",
)  # fmt: skip
DAYS = (
    date(2026, 3, 29), date(2026, 10, 25), date(2011, 12, 30), date(2018, 11, 4), date(2024, 2, 29), date(2026, 4, 5),
)  # fmt: skip
"""Nights in which some of these zones skip or repeat hours or days, and a day of a leap year."""

WATCHED = timedelta(days=9)


def watched(wanted: Schedule, after: datetime, zone: ZoneInfo) -> datetime | None:
    """Return the first minute later than `after` in which the clock shows a time of the schedule for the first time.

    Without such a minute within `WATCHED`, None is returned. The search begins two days earlier, and notes each time
    that was shown or skipped.
    """
    minute = after.replace(second=0, microsecond=0) - timedelta(days=2)
    furthest = minute.astimezone(zone).replace(tzinfo=None)
    while minute <= after + WATCHED:
        minute += timedelta(minutes=1)
        shown = minute.astimezone(zone).replace(tzinfo=None)
        passed = furthest
        while passed < shown:
            passed += timedelta(minutes=1)
            meant = not (wanted.weekdays or wanted.dates)
            meant |= passed.weekday() in wanted.weekdays or passed.date() in wanted.dates
            if meant and passed.hour * 60 + passed.minute in wanted.times and minute > after:
                return minute
        furthest = max(furthest, shown)
    return None


@settings(max_examples=60, deadline=None)
@given(
    zone=st.sampled_from(ZONES),
    day=st.sampled_from(DAYS),
    offset=st.integers(-3 * 24 * 60, 24 * 60),
    seconds=st.sampled_from((0, 0, 1, 59)),
    times=st.sets(st.one_of(st.integers(0, 23 * 60 + 59), st.integers(0, 4 * 60)), min_size=1, max_size=3),
    weekdays=st.sets(st.integers(0, 6), max_size=2),
    dates=st.sets(st.integers(-2, 4), max_size=2),
)
def test_a_schedule_comes_when_somebody_sees_it_come(
    zone: str, day: date, offset: int, seconds: int, times: set[int], weekdays: set[int], dates: set[int]
) -> None:
    schedule = Schedule(
        tuple(sorted(times)), tuple(sorted(weekdays)), tuple(sorted(day + timedelta(days=i) for i in dates))
    )
    after = datetime(day.year, day.month, day.day, tzinfo=UTC) + timedelta(minutes=offset, seconds=seconds)
    found = next_moment(schedule, int(after.timestamp()) * MICROSECONDS, zone)
    seen = watched(schedule, after, ZoneInfo(zone))
    if seen is None:
        assert found is None or found > (after + WATCHED).timestamp() * MICROSECONDS
    else:
        assert found == int(seen.timestamp()) * MICROSECONDS


@for_each(
    ("text", "after", "comes"),
    [
        ("02:30", "2026-03-28T12:00", "2026-03-29 03:00:00+02:00"),
        ("02:30", "2026-10-24T12:00", "2026-10-25 02:30:00+02:00"),
        ("02:30", "2026-10-25T02:30+02:00", "2026-10-26 02:30:00+01:00"),
        ("02:30", "2026-10-25T02:10+01:00", "2026-10-26 02:30:00+01:00"),
        ("18:00", "2026-06-01T18:00+02:00", "2026-06-02 18:00:00+02:00"),
        ("00:00", "2026-12-31T23:59+01:00", "2027-01-01 00:00:00+01:00"),
        ("fri-mon 10:00", "2026-06-01T10:00+02:00", "2026-06-05 10:00:00+02:00"),
        ("2026-12-24 14:00", "2026-06-01T10:00+02:00", "2026-12-24 14:00:00+01:00"),
        ("2026-12-24 14:00", "2026-12-24T14:00+01:00", None),
    ],
)
def test_the_night_that_skips_and_the_night_that_repeats(text: str, after: str, comes: str | None) -> None:
    at = datetime.fromisoformat(after)
    moment = int((at if at.tzinfo else at.replace(tzinfo=UTC)).timestamp()) * MICROSECONDS
    found = next_moment(read_schedule(text), moment, "Europe/Berlin")
    assert (None if found is None else str(local_time(found, "Europe/Berlin"))) == comes


@for_each(
    ("text", "times", "weekdays", "dates"),
    [
        ("9:05", [545], [], []),
        ("mon - fri 11:00, 15:00", [660, 900], [0, 1, 2, 3, 4], []),
        ("sat, mon 17:00", [1020], [0, 5], []),
        ("sun-mon 17:00", [1020], [0, 6], []),
        ("mon,2026-12-24 14:00", [840], [0], [date(2026, 12, 24)]),
    ],
)
def test_what_can_be_written(text: str, times: list[int], weekdays: list[int], dates: list[date]) -> None:
    assert read_schedule(text) == Schedule(tuple(times), tuple(weekdays), tuple(dates))


@for_each(
    ("text", "message", "hint"),
    [
        ("25:00", "`25:00` is not a time of day", "from `00:00` to `23:59`"),
        ("24:00", "`24:00` is not a time of day", "midnight is `00:00`"),
        ("18.00", "`18.00` is not a time of day", "write `18:00`"),
        ("6pm", "`6pm` is not", "write `18:00`"),
        ("mon 6 pm", "`6pm` is not", "write `18:00`"),
        ("12am", "`12am` is not", "write `00:00`"),
        ("mon-frd", "`frd` is not a day", "did you mean `fri`?"),
        ("Monday 18:00", "`Monday` is not a day", "write `mon`"),
        ("fri", "`fri` has no time of day", "write `fri 18:00`"),
        ("2026-02-30 10:00", "no `2026-02-30` in the calendar", "`2026-12-24`"),
        ("24.12.2026 10:00", "`24.12.2026` is not a date", "`2026-12-24`"),
        ("mon 10:00, sat 12:00", "`sat` is after a time", "use a separate row for other days"),
        ("10:00-18:00", "is not a time of day", "write the beginning here"),
        ("18:00,", "has nothing before or after it", "`mon-fri 18:00`"),
        ("", "has no time of day", "`mon-fri 18:00`"),
    ],
)
def test_what_can_not_be_written(text: str, message: str, hint: str) -> None:
    with pytest.raises(MisreadTimeError) as caught:
        read_schedule(text)
    assert message in str(caught.value)
    assert hint in caught.value.hint


@given(st.text(alphabet="0123456789:-, mondfri.", max_size=20))
def test_any_text_is_a_schedule_or_is_refused(text: str) -> None:
    with suppress(MisreadTimeError):
        found = read_schedule(text)
        assert found.times
        assert all(0 <= minute < 24 * 60 for minute in found.times)
        assert all(WEEKDAYS[day] for day in found.weekdays)
