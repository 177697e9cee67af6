"""A day's numbers as a table for a spreadsheet."""

import csv
import io
from typing import Any

from lumen.features.console.day import COUNTED, Day

RISKY = ("=", "+", "-", "@", "\t", "\r")
"""What a cell may not begin with: a spreadsheet would take it for a formula."""


def day_csv(day: Day) -> str:
    """Rows of `what`, `name` and `value`: the visits, then the day's numbers."""
    told, text = day.to_json(), io.StringIO()
    write = csv.writer(text)
    write.writerow(["date", "what", "name", "value"])
    for visit in told["visits"]:
        for key in ("began", "ended", "seconds", "visitor", "language", "asked", "missed"):
            write.writerow([told["date"], f"visit {visit['n']}", key, _cell(visit[key])])
    numbers: dict[str, Any] = told["numbers"]
    for key in ("visits", "mean_seconds", "longest_seconds", "falls"):
        write.writerow([told["date"], "day", key, _cell(numbers[key])])
    for key in ("hours", *COUNTED):
        for name, count in numbers[key]:
            write.writerow([told["date"], key, _cell(name), count])
    for one in numbers["unanswered"]:
        write.writerow([told["date"], "unanswered", _cell(one["text"]), one["count"]])
    return text.getvalue()


def _cell(value: object) -> str:
    text = "" if value is None else str(value)
    return f"'{text}" if text.startswith(RISKY) else text
