"""The journal of reloads: when, by whom and with what result, a line of JSON each, of bounded size."""

import json
import logging
import os
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import ModuleError
from lumen.language.iso_time import iso_time
from lumen.language.people import PersonName
from lumen.project.json_lines import forget_lines

_log = logging.getLogger(__name__)

JOURNAL_FILE = "journal.jsonl"
MAX_JOURNAL_BYTES = 1_000_000
"""The size above which a new file is begun [bytes]; only the file before it is kept."""


class Journal:
    """A writer of entries to `journal.jsonl` in a folder; without a folder, entries are dropped.

    A line is written as a whole. If writing fails, as on a full disk, the entry is lost without an error.
    """

    def __init__(self, folder: Path | None) -> None:
        self._file = folder and folder / JOURNAL_FILE
        self._writing = threading.Lock()

    def write(self, entry: Mapping[str, Any]) -> None:
        """Append an entry, preceded by the date and time (UTC)."""
        if self._file is None:
            return
        line = json.dumps({"time": iso_time(time.time(), offset=True), **entry}, ensure_ascii=False)
        with self._writing, suppress(OSError):
            if self._file.exists() and self._file.stat().st_size > MAX_JOURNAL_BYTES:
                os.replace(self._file, self._file.with_suffix(".jsonl.1"))
            with self._file.open("ab") as file:
                file.write(line.encode("utf-8", "replace") + b"\n")

    def forget(self, person: PersonName) -> None:
        """Delete the entries that name a person, on any thread; a failed write is logged."""
        if self._file is None:
            return
        try:
            with self._writing:
                forget_lines(self._file.with_suffix(".jsonl.1"), person)
                forget_lines(self._file, person)
        except ModuleError as error:
            _log.warning("the journal still contains data of a visitor that should be deleted: %s", error)

    def entries(self) -> Iterator[dict[str, Any]]:
        """Yield all entries that are still there, the oldest first, without lines that a crash cut off."""
        if self._file is None:
            return
        for file in (self._file.with_suffix(".jsonl.1"), self._file):
            with suppress(OSError):
                for line in file.read_bytes().splitlines():
                    with suppress(ValueError):
                        yield json.loads(line)
