"""Repeated warnings, logged once."""

import logging
from collections.abc import Iterable

MAX_LINES = 1_000
"""The most different lines that are logged; further ones are dropped."""


class OnceLog:
    """Logs each line once."""

    def __init__(self, log: logging.Logger) -> None:
        self._log = log
        self._lines: set[str] = set()

    def __call__(self, lines: Iterable[str]) -> None:
        for line in lines:
            if line not in self._lines and len(self._lines) < MAX_LINES:
                self._lines.add(line)
                self._log.warning("%s", line)
