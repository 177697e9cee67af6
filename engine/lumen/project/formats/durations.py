"""Convert delays in the form of CSS, which SCXML uses (`1.5s`, `100ms`), to Lumen's, and back."""

import re

MAX_DELAY = 1e15
"""The longest delay that is read [ms]."""
_DELAY = re.compile(r"\+?(\d+(?:\.\d+)?|\.\d+)(ms|s|min|m|h)?")
_FACTORS = {"": 1.0, "ms": 1.0, "s": 1e3, "min": 60e3, "m": 60e3, "h": 3600e3}


def milliseconds(text: str) -> float | None:
    """Return the delay [ms]; None if the text is not a valid delay or exceeds `MAX_DELAY`.

    A bare number is in ms, as in several tools. The result for an empty text is 0.
    """
    match = _DELAY.fullmatch(text.strip()) if text.strip() else None
    if match is None:
        return None if text.strip() else 0.0
    length = float(match[1]) * _FACTORS[match[2] or ""]
    return length if length <= MAX_DELAY else None


def duration(length: float) -> str:
    """Return a duration as text, from a length in [ms]: `20s`, `1.5s` or `500ms`."""
    if length >= 1000 and length == round(length):
        return f"{_plain(length / 1000)}s"
    return f"{_plain(length)}ms"


def _plain(number: float) -> str:
    return f"{number:.6f}".rstrip("0").rstrip(".")
