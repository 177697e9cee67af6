"""Parse durations as people write them: `500ms`, `20s`, `2min`."""

import re
from collections.abc import Mapping

from lumen.language.lookalikes import other_sign, typed

MAX_DURATION = 1e9
"""The longest duration that is accepted [s], a third of a century."""

_DURATION = re.compile(r"(\d+(?:\.\d+)?) ?(ms|s|min|h)")
_SECONDS: Mapping[str, float] = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}


_WORDS: Mapping[str, str] = {
    word: unit
    for unit, words in {
        "ms": "ms msec millis milliseconds",
        "s": "s sec secs sek second seconds sekunde sekunden detik",
        "min": "m min mins minute minutes minuten menit",
        "h": "h hr std hour hours stunde stunden jam",
    }.items()
    for word in words.split()
} | {"": "s"}
_LIKE_DURATION = re.compile(r"(\d+)(?:[.,](\d+))? ?([A-Za-z]*)\.?")


def meant_duration(text: object) -> str:
    """Return the duration that was probably meant by `30`, `4 Sekunden` or `1,5s`; empty if there is no similar one."""
    match = _LIKE_DURATION.fullmatch(f"{text:g}" if isinstance(text, float) else str(text).strip())
    if match is None or (unit := _WORDS.get(match[3].lower())) is None:
        return ""
    return f"{match[1]}.{match[2]}{unit}" if match[2] else f"{match[1]}{unit}"


def duration_hint(text: object) -> str:
    """Return the hint for a text that is not a duration."""
    if (sign := other_sign(str(text))) and seconds(plain := typed(str(text)).replace(",", ".")) is not None:
        return f"write `{plain}`: {sign}"
    if meant := meant_duration(text):
        short = f", or `{meant[:-1]}ms`" if str(text).strip().isdecimal() else ""
        return (
            f"write the unit too: `{meant}`{short}" if not str(text).strip(" .")[-1:].isalpha() else f"write `{meant}`"
        )
    return "write a number and its unit, such as `500ms`, `20s` or `2min`"


def seconds(text: object) -> float | None:
    """Return the duration [s] in a text such as `500ms`, `1.5s`, `2min` or `1h`; None for any other value.

    A duration longer than MAX_DURATION is not accepted either.
    """
    match = _DURATION.fullmatch(text) if isinstance(text, str) else None
    duration = float(match[1]) * _SECONDS[match[2]] if match else None
    return duration if duration is not None and duration <= MAX_DURATION else None
