"""Colour text on a terminal; elsewhere leave it plain."""

import os
import sys
from typing import TextIO

CODES = {
    "bold": "1",
    "dim": "2",
    "red": "31",
    "green": "32",
    "yellow": "33",
    "blue": "34",
    "magenta": "35",
    "cyan": "36",
}


def coloured(stream: TextIO | None = None) -> bool:
    """Return True if a stream is a terminal that shows colours: NO_COLOR is not set, and TERM is not `dumb`.

    The default is standard output.
    """
    return (stream or sys.stdout).isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"


def paint(text: str, *styles: str, on: bool) -> str:
    """Return the text in these styles, which are keys of CODES, if `on`; else unchanged."""
    if not on or not styles:
        return text
    return f"\x1b[{';'.join(CODES[s] for s in styles)}m{text}\x1b[0m"
