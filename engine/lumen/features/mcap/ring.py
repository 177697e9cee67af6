"""The last minutes of an exhibition, recorded continuously and kept if a moment is marked."""

import logging
import re
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.errors import LumenError
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import RecordingFile, writable
from lumen.features.mcap.files.rewriting import rewrite
from lumen.features.mcap.recordings_folder import SUFFIX, RecordingsFolder
from lumen.features.mcap.redaction import redacted
from lumen.language.iso_time import file_stamp
from lumen.language.people import PersonName
from lumen.language.retention import RecordingSettings

PIECE_PERIOD = 30.0
"""The length of a piece of the ring [s], and the most that is kept beyond the requested time."""
AFTER = 60.0
"""The time for which recording continues after a mark [s]."""
RETRY_PERIOD = 30.0
"""The pause after a disk error [s]."""
PATIENCE = 600.0
"""The time after which a marked recording that can't be written is given up [s]."""

_log = logging.getLogger(__name__)


class RingTape:
    """Keeps the last `settings.ring` seconds in pieces, and joins them into a recording if a moment is marked.

    It records for `AFTER` s after a mark; further marks extend this, up to the ring's length after the first mark.
    Consecutive recordings do not overlap. `first` returns the first items of each piece; `last` returns a recording's
    last items from the times when it began and ended [s since 1970] and its pieces. `kept` receives its path.
    """

    def __init__(
        self,
        folder: RecordingsFolder,
        settings: RecordingSettings,
        first: Callable[[], Iterable[Recorded]] = tuple,
        last: Callable[[float, float, Sequence[Path]], Iterable[Recorded]] = lambda began, ended, pieces: (),
        kept: Callable[[Path], None] = lambda path: None,
    ) -> None:
        self.trouble = ""
        self._folder, self._settings, self._first, self._last, self._kept = folder, settings, first, last, kept
        self._file: RecordingFile | None = None
        self._pieces: list[tuple[float, Path]] = []
        self._why, self._marked, self._until, self._retry = "", 0.0, 0.0, 0.0
        self._count = 0

    def write(self, items: Sequence[Recorded], now: float) -> None:
        """Write items, and begin a piece if necessary; drop them during the pause after an error."""
        if self._file is None and (items and now >= self._retry):
            self._begin(now)
        if self._file:
            try:
                self._file.write(items)
            except OSError as error:
                self._fail(error, now)

    def mark(self, why: str, now: float) -> None:
        """Keep the last minutes and the next `AFTER` s; the first reason `why` becomes the recording's name."""
        if not self._why:
            self._why, self._marked = why, now
        self._until = min(now + AFTER, self._marked + max(AFTER, self._settings.ring))

    def settle(self, now: float) -> None:
        """Complete a chunk, a piece, or a marked recording if it is due."""
        try:
            if self._file:
                self._file.settle()
            if self._why and now >= self._until:
                self._until = now + RETRY_PERIOD  # if it fails
                self._keep(now)
            elif self._pieces and (now - self._pieces[-1][0] >= PIECE_PERIOD or now < self._pieces[-1][0]):
                self._end()
                self._drop(now)
        except (OSError, LumenError) as error:
            self._fail(error, now)
            if self._why and now >= self._marked + PATIENCE:
                _log.warning("the recording of `%s` is given up: it could not be written for %g s", self._why, PATIENCE)
                self._why = ""

    def forget(self, people: Sequence[PersonName]) -> None:
        """Remove people from all pieces and kept recordings; log those that can't be rewritten."""
        self._end()
        for file in [*(piece for _, piece in self._pieces), *self._folder.files()]:
            for person in people:
                try:
                    found, changed = redacted(file, person)
                    if found:
                        rewrite([file], file, changed)
                except LumenError as error:
                    _log.warning("a recording still names a person who should be forgotten: %s", error)

    def close(self) -> None:
        """Keep the pieces if a moment is marked, else delete them.

        If the recording can't be written, its pieces stay for the next start.
        """
        try:
            if self._why:
                self._keep(time.time())
        except (OSError, LumenError) as error:
            self._fail(error, time.time())
        self._end()
        self._drop(float("inf"))

    def _begin(self, now: float) -> None:
        try:
            self._folder.make()
            self._count += 1
            path = self._folder.ring / f"{int(now * 1000):015d}-{self._count:06d}{SUFFIX}"
            self._file = RecordingFile(path)
            self._pieces.append((now, path))
            self._file.write(self._first())
            self.trouble = ""
        except (OSError, LumenError) as error:
            self._fail(error, now)

    def _end(self) -> None:
        file, self._file = self._file, None
        if file:
            try:
                file.finish()
            except OSError as error:
                self._fail(error, time.time())

    def _drop(self, now: float) -> None:
        """Delete the pieces that ended more than the ring's length before the mark, or before `now` without one."""
        latest = self._marked if self._why else now
        while self._pieces and self._ended(0) < latest - self._settings.ring:
            with suppress(OSError):
                self._pieces[0][1].unlink()
            del self._pieces[0]

    def _ended(self, number: int) -> float:
        after = self._pieces[number + 1 :]
        return after[0][0] if after else self._pieces[number][0] + (PIECE_PERIOD if self._file else 0.0)

    def _keep(self, now: float) -> None:
        """Join the pieces into a recording, delete them, remove the mark, and prune the folder.

        Without pieces, only remove the mark. If the recording can't be written, the mark and the pieces stay.
        """
        self._end()
        pieces = [piece for _, piece in self._pieces]
        if not pieces:
            self._why = ""
            return
        began = self._pieces[0][0]
        path = kept_as(self._folder, self._marked, self._why)
        rewrite(pieces, path, more=self._last(began, now, pieces))
        self._pieces, self._why = [], ""
        for piece in pieces:
            with suppress(OSError):
                piece.unlink()
        self._folder.prune(now, self._settings.keep, self._settings.size)
        self._kept(path)

    def _fail(self, error: Exception, now: float) -> None:
        """Report the first error, and retry after RETRY_PERIOD; existing pieces stay."""
        self._retry = now + RETRY_PERIOD
        if not self.trouble:
            self.trouble = (
                f"the last minutes can't be recorded: {(getattr(error, 'strerror', None) or str(error)).lower()}"
            )
            _log.warning("%s", self.trouble)
        if self._file:
            self._file.abandon()
            self._file = None


def kept_as(folder: RecordingsFolder, at: float, why: str) -> Path:
    """Return the path for a recording made at `at` [s since 1970] for the reason `why`."""
    word = re.sub(r"[^\w]+", "-", why.lower()).strip("-")[:40]
    return writable(folder.path / f"{file_stamp(at)}-{word or 'mark'}{SUFFIX}")
