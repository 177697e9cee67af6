"""Repairs, at the next start, recordings that a killed run left incomplete."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from lumen.errors import LumenError, RecordingError
from lumen.features.mcap.files.reading import whole
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.rewriting import recover, rewrite
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.ring import kept_as
from lumen.language.counts import counted
from lumen.upkeep.threads import WatchedThread

Explaining = Callable[[Sequence[Path]], Iterable[Recorded]]
"""Returns the items that explain a recording of these pieces."""


class RecordingRescue:
    """Repairs incomplete recordings on a separate thread, and reports them with `tell`.

    The remaining pieces of a ring are joined into a recording, because their run ended unexpectedly. The thread is
    started only if there is work.
    """

    def __init__(
        self, folder: RecordingsFolder, tell: Callable[[str], None], explaining: Explaining = lambda pieces: ()
    ) -> None:
        self._folder, self._tell, self._explaining = folder, tell, explaining
        self._pieces = folder.parts()
        self._cut = [each.path for each in folder.begun() if not each.written and _is_cut(each.path)]
        self._thread = WatchedThread("lumen-recovery", self._run)
        if self._pieces or self._cut:
            self._thread.start()

    def close(self, patience: float = 20.0) -> None:
        """Wait at most `patience` [s] until all repairs are done."""
        if self._thread.started:
            self._thread.join(patience)

    def _run(self) -> None:
        while self._cut:
            path = self._cut.pop()
            with _telling(self._tell, path):
                remove_drafts(path)
                self._tell(f"{path} was cut off and has been repaired: {counted(recover(path) or 0, 'message')}")
        pieces, self._pieces = self._pieces, []
        if pieces:
            with _telling(self._tell, pieces[-1]):
                path = kept_as(self._folder, pieces[-1].stat().st_mtime, "crashed")
                good = [piece for piece in pieces if _readable(piece)]
                count = rewrite(good, path, more=self._explaining(good)) if good else 0
                for piece in pieces:
                    piece.unlink(missing_ok=True)
                if count:
                    said = f"the last minutes of the run that ended unexpectedly are in {path}"
                    self._tell(f"{said}: {counted(count, 'message')}")
                else:
                    path.unlink(missing_ok=True)


@contextmanager
def _telling(tell: Callable[[str], None], path: Path) -> Iterator[None]:
    """Report a recording that can't be repaired, and leave it as it is."""
    try:
        yield
    except (LumenError, OSError) as error:
        tell(f"{path.name} can't be recovered: {error}")


def remove_drafts(path: Path) -> None:
    """Delete a recording's incomplete drafts."""
    for draft in path.parent.glob(f"{path.name}.*.new"):
        with suppress(OSError):
            draft.unlink()


def _is_cut(path: Path) -> bool:
    try:
        return not whole(path)
    except RecordingError:
        return False


def _readable(piece: Path) -> bool:
    """Return whether a piece is a recording: a file that was cut off in its first bytes is not."""
    try:
        whole(piece)
    except RecordingError:
        return False
    return True
