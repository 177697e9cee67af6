"""`--at T`: a moment as people say it."""

from datetime import UTC, datetime, timedelta

from lumen.errors import UsageError
from lumen.language.iso_time import time_of_day


def moment(text: str, now: datetime) -> str:
    """The end of the minute `14:03`, or of the second `14:03:20`, the last time that a clock here showed it.

    `now` is the time here. What is written with a date is that moment. ISO 8601 in UTC; raises UsageError for what is
    no time.
    """
    try:
        if "-" in text:
            return datetime.fromisoformat(text).astimezone(UTC).isoformat()
        of_day = time_of_day(text)
    except ValueError:
        raise UsageError(f"`{text}` is not a time: write 14:03, 14:03:20, or 2026-11-22T14:03:20") from None
    begin = datetime.combine(now.date(), of_day, now.tzinfo)
    if begin > now:
        begin -= timedelta(days=1)
    length = timedelta(minutes=1) if text.count(":") == 1 else timedelta(seconds=1)
    return (begin + length - timedelta(milliseconds=1)).astimezone(UTC).isoformat()
