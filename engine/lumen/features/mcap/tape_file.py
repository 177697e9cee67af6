"""Records into one file, from its creation to `close`."""

import logging
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from lumen.errors import LumenError
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import RecordingFile
from lumen.features.mcap.files.rewriting import reopened
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.redaction import redacted
from lumen.language.people import PersonName

_log = logging.getLogger(__name__)


class FileTape:
    """Writes one recording.

    `first` are its first items; `last` receives the time when it began [s since 1970] and returns its last items.

    A disk error is reported once and ends the recording; the items already written stay. Raises OSError or LumenError
    if the file can't be created.
    """

    def __init__(
        self,
        path: Path,
        folder: RecordingsFolder,
        first: Iterable[Recorded] = (),
        last: Callable[[float], Iterable[Recorded]] = lambda began: (),
    ) -> None:
        self.path, self.trouble, self.bytes = path, "", 0
        self._began, self._last = time.time(), last
        self._file: RecordingFile | None = RecordingFile(path)
        self.messages = 0
        self._note = folder.begin(path)
        self.write(list(first), self._began)

    def write(self, items: Sequence[Recorded], now: float) -> None:
        """Write items, unless an error has ended the recording."""
        self._try(lambda file: file.write(items))

    def mark(self, why: str, now: float) -> None:
        """Do nothing: the whole recording is kept."""

    def settle(self, now: float) -> None:
        """Complete a chunk and sync the file, each if it is due."""
        self._try(lambda file: file.settle())

    def forget(self, people: Sequence[PersonName]) -> None:
        """Rewrite the recording without these people, and continue."""
        for person in people:
            self._try(lambda file, person=person: self._forget(file, person))  # type: ignore[misc]

    def close(self) -> None:
        """Write the last items and the index, and close the file."""

        def end(file: RecordingFile) -> None:
            file.write(self._last(self._began))
            file.finish()
            self.bytes = self.path.stat().st_size

        self._try(end)
        self._file = None
        if self._note:
            self._note.release()

    def _forget(self, file: RecordingFile, person: PersonName) -> None:
        file.finish()
        self._file = reopened(self.path, redacted(self.path, person)[1])

    def _try(self, work: Callable[[RecordingFile], None]) -> None:
        """Run `work` with the file if it is open; an error ends the recording, and is not raised."""
        if self._file is None:
            return
        try:
            work(self._file)
            self.messages = self._file.messages
        except (OSError, LumenError) as error:
            self.trouble = f"the recording {self.path.name} can't be written: {_reason(error)}"
            _log.warning("%s; `lumen record --recover` repairs the file", self.trouble)
            self._file.abandon()
            self._file = None


def _reason(error: Exception) -> str:
    return (getattr(error, "strerror", None) or str(error)).lower()
