"""Parse times of day as people write them: `18:00`, `mon-fri 11:00, 15:00`, `2026-12-24 14:00`."""

import re
from collections.abc import Iterator
from datetime import date

from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean
from lumen.language.hours import WEEKDAYS, Schedule
from lumen.language.text_lines import lines_of
from lumen.project.document_report import DocumentReport

BAD_TIME = Code("bad-time", "statecharts", ERROR, "a time of day can't be read")
UNQUOTED_TIME = Code(
    "unquoted-time", "statecharts", WARNING, "a time of day has no quotes, so some YAML readers read it as a number"
)

TIME_HINT = "write a time such as `18:00`, `mon-fri 18:00`, `sat,sun 11:00, 15:00` or `2026-12-24 14:00`"

_TIME = re.compile(r"([0-9]{1,2}):([0-9]{2})")
_DATE = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}")
_OTHER_TIME = re.compile(r"([0-9]{1,2})(?:[.:h]?([0-9]{2}))? ?h?([ap]m)?(?::[0-9]{2})?", re.IGNORECASE)
_OTHER_DATE = re.compile(r"[0-9]{1,4}[./][0-9]{1,2}[./][0-9]{0,4}|[0-9]{1,4}-[0-9]{1,2}-[0-9]{1,4}")
_ISO = re.compile(
    r"([0-9]{4}-[0-9]{2}-[0-9]{2})[Tt]([0-9]{1,2}:[0-9]{2})(?::[0-9]{2}(?:\.[0-9]+)?)?([Zz]|[+-][0-9:]+)?"
)
_CRON = re.compile(r"(?:[0-9*/,?L#-]+|[A-Za-z]{3}(?:[-,][A-Za-z]{3})*)")
_SEXAGESIMAL = re.compile(r"[1-9][0-9]?:[0-5][0-9]")
"""A text that YAML 1.1 reads as a number to the base 60 if it is not quoted."""


class MisreadTimeError(Exception):
    """Raised if a time of day can't be read. The message is the reason; `hint` shows a valid form."""

    def __init__(self, message: str, hint: str = TIME_HINT) -> None:
        super().__init__(message)
        self.hint = hint


def read_schedule(text: str) -> Schedule:
    """Return the schedule that a text describes. Raises MisreadTimeError if the text can't be read."""
    times: set[int] = set()
    weekdays: set[int] = set()
    dates: set[date] = set()
    if hint := _iso(text) or _cron(text):
        raise MisreadTimeError(f"`{text}` is not a time of day", hint)
    for word in _words(text):
        named, dated = word[0].isalpha(), _OTHER_DATE.fullmatch(word)
        if (named or dated) and times:
            raise MisreadTimeError(
                f"`{word}` is after a time", "write the days before the times; use a separate row for other days"
            )
        if named:
            weekdays.update(_weekdays(word))
        elif dated:
            dates.add(_date(word))
        else:
            times.add(_time(word))
    if not times:
        raise MisreadTimeError(
            f"`{text}` has no time of day", f"write `{text.strip()} 18:00`" if text.strip() else TIME_HINT
        )
    return Schedule(tuple(sorted(times)), tuple(sorted(weekdays)), tuple(sorted(dates)), " ".join(text.split()))


def schedule(text: object, report: DocumentReport, where: NodePath, *, key: bool = False) -> Schedule | None:
    """Return the schedule at `where` (with `key`, in the key); None if it can't be read, which is reported."""
    try:
        found = read_schedule(str(text))
    except MisreadTimeError as error:
        report(BAD_TIME, where, str(error), hint=error.hint, key=key)
        return None
    if _SEXAGESIMAL.fullmatch(str(text)) and not _quoted(report, where, key):
        message = f"without quotes, some YAML readers read `{text}` as the number {found.times[0]}"
        report(UNQUOTED_TIME, where, message, hint=f'write `"{text}"`', key=key)
    return found


def _words(text: str) -> Iterator[str]:
    """Yield the parts between blanks and commas; `mon - fri` is one part, and so is `6 pm`."""
    parts = re.sub(r"(?i)(?<=[0-9])\s+(?=[ap]m\b)", "", re.sub(r"\s*-\s*", "-", text.strip()))
    for word in re.split(r"\s*,\s*|\s+", parts) if parts else ():
        if not word:
            raise MisreadTimeError(f"a comma in `{text}` has nothing before or after it")
        yield word


def _time(word: str) -> int:
    """Return the minutes since midnight. Raises MisreadTimeError for any text but `HH:MM`."""
    if not (match := _TIME.fullmatch(word)):
        raise MisreadTimeError(f"`{word}` is not a time of day", _other_time(word))
    hour, minute = int(match[1]), int(match[2])
    if hour > 23 or minute > 59:
        midnight = "; midnight is `00:00`" if (hour, minute) == (24, 0) else ""
        raise MisreadTimeError(f"`{word}` is not a time of day", f"write a time from `00:00` to `23:59`{midnight}")
    return hour * 60 + minute


def _other_time(word: str) -> str:
    """Return a hint for a time in another notation."""
    if match := _OTHER_TIME.fullmatch(word):
        hour, minute, half = int(match[1]), int(match[2] or 0), (match[3] or "").lower()
        if half and 1 <= hour <= 12:
            hour = hour % 12 + (12 if half == "pm" else 0)
        if hour < 24 and minute < 60:
            return f"write `{hour:02}:{minute:02}`"
    if "-" in word:
        return "`at` is one moment, not a period: write the beginning here, and the end in another state"
    return TIME_HINT


def _iso(text: str) -> str:
    """Return the hint for `2026-12-24T18:00`, ISO 8601 with a `T`; empty for any other text."""
    if (found := _ISO.fullmatch(text.strip())) is None:
        return ""
    zone = "; convert it to the project's time zone (`timezone` in lumen.yaml)" if found[3] else ""
    written = f"{found[1]} {found[2].zfill(5)}"
    try:
        read_schedule(written)
    except MisreadTimeError:
        written = "2026-12-24 18:00"  # an example of the form only
    return f"write `{written}`{zone}"


_CRON_DAYS = dict(zip("01234567", ("sun", *WEEKDAYS), strict=True))


def _cron(text: str) -> str:
    """Return the hint for a line of cron; empty for any other text."""
    fields = text.split()
    fields = fields[1:6] if len(fields) in (6, 7) else fields
    if len(fields) != 5 or not all(map(_CRON.fullmatch, fields)) or all(f.isalpha() for f in fields):
        return ""
    minute, hour, day, month, weekday = fields
    hint = "this is cron syntax: write days before times, as in `mon-fri 18:00`"
    if not (minute.isdigit() and re.fullmatch(r"[0-9]+(,[0-9]+)*", hour) and (day, month) in (("*", "*"), ("?", "*"))):
        return hint
    weekday = "*" if weekday in ("0-6", "0-7", "1-7") else weekday
    days = re.sub("[0-7]", lambda found: _CRON_DAYS[found[0]], weekday.lower()).strip("*?")
    times = ", ".join(f"{int(each):02}:{int(minute):02}" for each in hour.split(","))
    written = f"{days} {times}".strip()
    try:
        read_schedule(written)
    except MisreadTimeError:
        return hint
    return f"this is cron syntax: write `{written}`"


def _date(word: str) -> date:
    if not _DATE.fullmatch(word):
        raise MisreadTimeError(f"`{word}` is not a date", "write year, month and day: `2026-12-24`")
    try:
        return date.fromisoformat(word)
    except ValueError:
        raise MisreadTimeError(
            f"there is no `{word}` in the calendar", "write year, month and day: `2026-12-24`"
        ) from None


def _weekdays(word: str) -> Iterator[int]:
    """Yield the days of `sat` or `fri-mon`, as numbers from 0; a range may continue from Sunday to Monday."""
    first, dash, last = word.partition("-")
    begin = _weekday(first)
    end = _weekday(last) if dash else begin
    yield from ((begin + i) % 7 for i in range((end - begin) % 7 + 1))


def _weekday(word: str) -> int:
    if word in WEEKDAYS:
        return WEEKDAYS.index(word)
    short = word[:3].lower()
    if short in WEEKDAYS and word.lower().isalpha():
        raise MisreadTimeError(f"`{word}` is not a day", f"write `{short}`")
    raise MisreadTimeError(f"`{word}` is not a day", did_you_mean(word, WEEKDAYS, "the days are"))


def _quoted(report: DocumentReport, where: NodePath, key: bool) -> bool:
    """Return True if that node is written with quotes."""
    place = report.document.place(where, key=key)
    lines = lines_of(report.document.text)
    line = lines[place.line - 1] if 0 < place.line <= len(lines) else ""
    return line[place.column - 1 : place.column] in ("'", '"', "|", ">")
