"""A log of the commands that a robot has begun, for the process that follows one that was killed."""

import json
import logging
import os
import time
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from lumen.upkeep.own_folders import private_folder

DEDUPLICATION_FILE = "commands.jsonl"
"""The name of the log among the files that an exhibition keeps from run to run."""
MAX_LOGGED_IDS = 1_000
"""The number of latest commands that are kept."""
DEDUPLICATION_WINDOW = 60.0
"""The time within which a command may arrive again [s]: longer than a broker keeps it, or a brain awaits its answer."""

_log = logging.getLogger(__name__)


class BegunCommand(NamedTuple):
    """A command that was begun."""

    at: float
    """When the command was begun [s since 1970]."""
    id: str
    """The id that its sender gave the command."""
    sender: str | None = None
    """The name of the sender; None in a file of an older version, which did not record senders."""


class DeduplicationLog:
    """The begun commands in a file, one per line, each written before its command begins; without a file, none.

    `before` are those of the previous process that are younger than `DEDUPLICATION_WINDOW`, the oldest first; older
    ones are ignored, because a sender may count its commands from 1 at each start. Each line is passed to the operating
    system at once, so a killed process loses none. If the disk refuses, that is logged once, and the robot performs the
    command all the same.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._file, self._lines, self._warned = file, 0, False
        since = time.time() - DEDUPLICATION_WINDOW
        self.before = tuple(command for command in self._read() if command.at >= since)

    def note(self, id: str, sender: str) -> None:
        """Record that this command of that sender is begun now."""
        if self._file is None:
            return
        if self._lines >= 2 * MAX_LOGGED_IDS:
            self._shorten()
        self._write(_line(BegunCommand(time.time(), id, sender)), os.O_APPEND)
        self._lines += 1

    def _read(self) -> list[BegunCommand]:
        """Return the commands in the file, except for a line that was cut short."""
        found: deque[BegunCommand] = deque(maxlen=MAX_LOGGED_IDS)
        if self._file is not None:
            with suppress(OSError), self._file.open(encoding="utf-8", errors="replace") as lines:
                for line in lines:
                    self._lines += 1
                    with suppress(ValueError, TypeError, OverflowError, RecursionError):
                        at, id, *rest = json.loads(line)
                        found.append(BegunCommand(float(at), str(id), str(rest[0]) if rest else None))
        return list(found)

    def _shorten(self) -> None:
        self._lines = 0
        kept = self._read()
        self._write("".join(_line(command) for command in kept), os.O_TRUNC)
        self._lines = len(kept)

    def _write(self, text: str, how: int) -> None:
        assert self._file is not None
        try:
            private_folder(self._file.parent)
            file = os.open(self._file, os.O_WRONLY | os.O_CREAT | how, 0o600)
            try:
                os.write(file, text.encode())
            finally:
                os.close(file)
        except OSError as error:
            if not self._warned:
                self._warned = True
                _log.warning("the list of begun commands cannot be written to %s: %s", self._file, error.strerror)


def _line(command: BegunCommand) -> str:
    sender = [] if command.sender is None else [command.sender]
    return json.dumps([round(command.at, 3), command.id, *sender]) + "\n"
