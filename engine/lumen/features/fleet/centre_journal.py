"""The journal of a centre's decisions, one per line; each decision is on disk before the centre sends it."""

import json
import os
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.features.fleet.rollouts.state import CentreState, state_from_json, state_to_json
from lumen.language.iso_time import iso_time
from lumen.upkeep.own_folders import private_folder

FILE = "centre.jsonl"
TAIL = 4_000_000
"""The size of the file's end that is searched for the last state [bytes]."""


class CentreJournal:
    """The journal in a folder; the first line creates both."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / FILE

    def last(self) -> CentreState | None:
        """Return the last valid state in the journal, or None; a line that a crash cut off is ignored."""
        for row in reversed(self.rows()):
            with suppress(KeyError, TypeError, ValueError):
                return state_from_json(row["state"])
        return None

    def rows(self) -> list[Mapping[str, Any]]:
        """Return the lines in the file's last `TAIL` bytes, newest last; empty if the file can't be read.

        Each line has the time `at`, `what` happened, and the `state` after that.
        """
        try:
            with open(self.file, "rb") as opened:
                opened.seek(max(0, self.file.stat().st_size - TAIL))
                lines = opened.read().splitlines()
        except OSError:
            return []
        found = []
        for line in lines:
            with suppress(ValueError, RecursionError):
                row = json.loads(line)
                if isinstance(row, Mapping):
                    found.append(row)
        return found

    def write(self, what: str, state: CentreState) -> str:
        """Add a line and wait until it is on disk; return the error, else an empty string."""
        row = {"at": iso_time(time.time(), "seconds", offset=True), "what": what, "state": state_to_json(state)}
        try:
            private_folder(self.file.parent)
            with open(self.file, "ab") as opened:
                opened.write(b"\n" * self._torn() + json.dumps(row).encode() + b"\n")
                opened.flush()
                os.fsync(opened.fileno())
        except OSError as error:
            return (error.strerror or str(error)).lower()
        return ""

    def _torn(self) -> bool:
        """Return whether a crash has cut off the last line."""
        if not self.file.exists() or not self.file.stat().st_size:
            return False
        with open(self.file, "rb") as opened:
            opened.seek(-1, os.SEEK_END)
            return opened.read(1) != b"\n"
