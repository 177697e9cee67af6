"""Times as texts: ISO 8601 in UTC for programs, local time for people. Numbers are seconds since 1970."""

from datetime import UTC, datetime, time
from typing import Literal

Precision = Literal["seconds", "milliseconds"]


def iso_time(at: float, precision: Precision = "milliseconds", *, offset: bool = False) -> str:
    """Return a time as `2026-11-22T18:00:00.000Z`; with `offset`, `+00:00` replaces `Z`, as in messages and kept files.

    Raises ValueError, OverflowError or OSError for a time outside the years 1 to 9999.
    """
    text = datetime.fromtimestamp(at, UTC).isoformat(timespec=precision)
    return text if offset else text.replace("+00:00", "Z")


def time_of(text: str) -> float:
    """Return the time of an ISO 8601 text; without an offset it is local. Raises ValueError for other texts."""
    try:
        return datetime.fromisoformat(text).timestamp()
    except (OverflowError, OSError) as error:
        raise ValueError(f"`{text[:40]}` is beyond the calendar") from error


def time_of_day(text: str) -> time:
    """Return the time of day of `9:03`, `14:03` or `14:03:20`. Raises ValueError for a text in another form."""
    return time.fromisoformat(text.zfill(5) if text.count(":") == 1 else text.zfill(8))


def local_time(at: float) -> str:
    """Return a time as the clock of this machine shows it: `2026-11-22 19:00:00`."""
    return f"{datetime.fromtimestamp(at):%Y-%m-%d %H:%M:%S}"


def file_stamp(at: float) -> str:
    """Return a time in UTC for the name of a file: `2026-11-22T18-00-00Z`."""
    return f"{datetime.fromtimestamp(at, UTC):%Y-%m-%dT%H-%M-%SZ}"
