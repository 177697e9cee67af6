"""Rewrites recordings: to add the index after a crash, to join several, or to remove items."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.errors import RecordingError
from lumen.features.mcap.files.reading import read_recording, whole
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import RecordingFile

Changed = Callable[[Recorded], Recorded | None]
"""Returns the item to write in place of a recorded one; None to leave it out."""


def rewrite(
    sources: Sequence[Path], target: Path, changed: Changed = lambda item: item, more: Iterable[Recorded] = ()
) -> int:
    """Write the sources' readable items, as `changed` returns them, then `more`, to `target`; return the message count.

    The target, which can be one of the sources, is replaced only after everything is written. Raises RecordingError if
    a source is not a recording, or the disk fails.
    """
    draft = target.with_name(f"{target.name}.{os.getpid()}.new")
    try:
        written = RecordingFile(draft)
        try:
            for source in sources:
                written.write(_changed(source, changed))
            written.write(more)
            written.finish()
        finally:
            written.abandon()
        if len(sources) == 1 and target in sources:
            was = target.stat()
            os.utime(draft, ns=(was.st_atime_ns, was.st_mtime_ns))  # keep its age
        os.replace(draft, target)
    except OSError as error:
        raise RecordingError(f"{target} can't be written: {error.strerror}") from None
    finally:
        with suppress(OSError):
            draft.unlink()
    return written.messages


def recover(path: Path) -> int | None:
    """Repair an incomplete recording in place; return the number of its messages, None if it was complete.

    Raises RecordingError if it is not a recording, or the disk fails.
    """
    return None if whole(path) else rewrite([path], path)


def reopened(path: Path, changed: Changed) -> RecordingFile:
    """Rewrite a recording with changes; return it, open for further items.

    Raises RecordingError if the file is not a recording, OSError if the disk fails.
    """
    draft = path.with_name(f"{path.name}.{os.getpid()}.new")
    written = RecordingFile(draft)
    try:
        written.write(_changed(path, changed))
        os.replace(draft, path)
    except BaseException:
        written.abandon()
        with suppress(OSError):
            draft.unlink()
        raise
    written.path = path
    return written


def _changed(source: Path, changed: Changed) -> Iterator[Recorded]:
    for item in read_recording(source):
        if (found := changed(item)) is not None:
            yield found
