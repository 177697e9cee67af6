"""How changes show times, numbers and texts."""

from typing import Any

MAX_SHOWN_CHARACTERS = 60
"""Characters of a text that are shown; a longer text is cut."""


def seconds(time: float | None) -> str:
    """Return a time in [s] as text: `3 s`, `500 ms` or `2 min`; `none` for None."""
    if time is None:
        return "none"
    if time and time < 1.0:
        return f"{time * 1000:g} ms"
    return f"{time / 60:g} min" if time >= 60 and time % 60 == 0 else f"{time:g} s"


def quoted(text: str) -> str:
    """Return a text as one line in quotation marks, cut to `MAX_SHOWN_CHARACTERS`."""
    line = " ".join(text.split())
    return f"“{line if len(line) <= MAX_SHOWN_CHARACTERS else line[: MAX_SHOWN_CHARACTERS - 1] + '…'}”"


def code(value: Any) -> str:
    """Return a name, an expression or a value as one line in backticks, cut to `MAX_SHOWN_CHARACTERS`."""
    text = str(value).replace("\n", " ")
    return f"`{text if len(text) <= MAX_SHOWN_CHARACTERS else text[: MAX_SHOWN_CHARACTERS - 1] + '…'}`"


def names(found: Any) -> str:
    """Return names as a list in words: `a`, `b` and `c`."""
    shown = [f"`{name}`" for name in found]
    return f"{', '.join(shown[:-1])} and {shown[-1]}" if len(shown) > 1 else "".join(shown)


def how_many(number: int, what: str) -> str:
    """Return a number with its noun: `1 text`, `2 texts`, `2 stories`."""
    if number == 1:
        return f"1 {what}"
    return f"{number} {what[:-1]}ies" if what.endswith("y") else f"{number} {what}s"
