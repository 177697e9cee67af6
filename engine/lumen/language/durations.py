"""Lengths of time as one writes them: `500ms`, `20s`, `2min`."""

import re
from collections.abc import Mapping

MAX_DURATION = 1e9
"""A third of a century [s]: what is longer is a slip."""

_DURATION = re.compile(r"(\d+(?:\.\d+)?) ?(ms|s|min|h)")
_SECONDS: Mapping[str, float] = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}


def seconds(text: object) -> float | None:
    """The duration in [s] of `500ms`, `20s`, `1.5s`, `2min` or `1h`; None where it is not one, or longer than any."""
    match = _DURATION.fullmatch(text) if isinstance(text, str) else None
    duration = float(match[1]) * _SECONDS[match[2]] if match else None
    return duration if duration is not None and duration <= MAX_DURATION else None
