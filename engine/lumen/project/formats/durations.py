"""Delays: `1.5s` and `100ms` in CSS, which SCXML uses, and ours."""

import re

MAX_DELAY = 1e15
"""[ms]"""
_DELAY = re.compile(r"\+?(\d+(?:\.\d+)?|\.\d+)(ms|s|min|m|h)?")
_FACTORS = {"": 1.0, "ms": 1.0, "s": 1e3, "min": 60e3, "m": 60e3, "h": 3600e3}


def milliseconds(text: str) -> float | None:
    """[ms], None where the text is no delay, or longer than any; a bare number counts them, as several tools do."""
    match = _DELAY.fullmatch(text.strip()) if text.strip() else None
    if match is None:
        return None if text.strip() else 0.0
    length = float(match[1]) * _FACTORS[match[2] or ""]
    return length if length <= MAX_DELAY else None


def duration(length: float) -> str:
    """`20s`, `1.5s` or `500ms` of so many [ms]."""
    if length >= 1000 and length == round(length):
        return f"{_plain(length / 1000)}s"
    return f"{_plain(length)}ms"


def _plain(number: float) -> str:
    return f"{number:.6f}".rstrip("0").rstrip(".")
