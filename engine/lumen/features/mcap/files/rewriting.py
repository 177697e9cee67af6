"""Recordings written anew: with their index after a cut, several as one, or without what is not to be in them."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.errors import RecordingError
from lumen.features.mcap.files.reading import read_recording, whole
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import RecordingFile

Changed = Callable[[Recorded], Recorded | None]
"""What becomes of an item of a recording; None where it is left out."""


def rewrite(
    sources: Sequence[Path], target: Path, changed: Changed = lambda item: item, more: Iterable[Recorded] = ()
) -> int:
    """Write what can be read of these recordings as one, and `more`, as a whole or not at all; how many messages.

    `target` may be one of the sources. Raises RecordingError where one is none, or the disk refuses.
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
            os.utime(draft, ns=(was.st_atime_ns, was.st_mtime_ns))  # it is as old as it was
        os.replace(draft, target)
    except OSError as error:
        raise RecordingError(f"{target} can't be written: {error.strerror}") from None
    finally:
        with suppress(OSError):
            draft.unlink()
    return written.messages


def recover(path: Path) -> int | None:
    """Give a recording that was cut its index, in place; how many messages it has, None where it needs nothing.

    Raises RecordingError as `rewrite` does.
    """
    return None if whole(path) else rewrite([path], path)


def reopened(path: Path, changed: Changed) -> RecordingFile:
    """A recording with what is changed, open to be written on. Raises as `rewrite` does, and OSError."""
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
