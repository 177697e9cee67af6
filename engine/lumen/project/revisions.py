"""Read the files of a project at a revision of its git repository, without a checkout."""

import os
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.project.files import MAX_FILE_BYTES, MAX_PROJECT_BYTES, Unreadable, belongs, composed
from lumen.upkeep.regular_files import MEGABYTE


def files_at(root: Path, revision: str) -> dict[str, bytes] | None:
    """Return the files of the project at `root` at a revision; None if git has no such revision.

    A file that was too large is `Unreadable`. Raises UsageError if git is not installed, if `root` is not in a
    repository, or if the whole project was too large.
    """
    where = _git(root, "rev-parse", "--show-prefix")
    if where is None:
        raise UsageError(f"`{revision}` is not a folder, and {root} is not in a git repository, so it has no revisions")
    commit = _git(root, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    if commit is None:
        return None
    tree = f"{commit.decode().strip()}:{os.fsdecode(where).strip()}"
    listed = _git(root, "ls-tree", "-r", "-l", "-z", "--full-tree", tree) or b""
    blobs = [blob for blob in _blobs(listed) if belongs(blob.path)]
    read = [blob for blob in blobs if blob.size <= MAX_FILE_BYTES]
    large: dict[str, bytes] = {blob.path: Unreadable(b"it is too large") for blob in blobs if blob not in read}
    if sum(blob.size for blob in read) > MAX_PROJECT_BYTES:
        raise UsageError(f"the project was larger than {MAX_PROJECT_BYTES // MEGABYTE} MB at `{revision}`")
    contents = _contents(root, [blob.id for blob in read])
    return dict(sorted({**large, **dict(zip((blob.path for blob in read), contents, strict=True))}.items()))


class _Blob(NamedTuple):
    """A file of a revision and its size [bytes]."""

    path: str
    id: str
    size: int


def _blobs(listed: bytes) -> Iterator[_Blob]:
    """Yield every regular file in the output of `git ls-tree -l -z`."""
    for row in filter(None, listed.split(b"\0")):
        about, _, path = row.partition(b"\t")
        mode, _, id, size = about.decode().split()
        if mode in ("100644", "100755"):
            yield _Blob(composed(path.decode("utf-8", "replace")), id, int(size))


def _contents(root: Path, ids: Sequence[str]) -> list[bytes]:
    """Return the contents of these files, in their order."""
    found, text = [], _git(root, "cat-file", "--batch", given="".join(f"{id}\n" for id in ids).encode()) or b""
    while text:
        head, _, text = text.partition(b"\n")
        size = int(head.split()[2])
        found.append(text[:size])
        text = text[size + 1 :]
    return found


def _git(root: Path, *arguments: str, given: bytes = b"") -> bytes | None:
    """Return the output of git; None if it fails. Raises UsageError if git is not installed."""
    try:
        done = subprocess.run(
            ["git", "-C", str(root), *arguments],
            input=given,
            capture_output=True,
            check=False,
            env={**os.environ, "GIT_OPTIONAL_LOCKS": "0"},
        )
    except OSError:
        raise UsageError("git is not installed, so revisions can't be read") from None
    return done.stdout if done.returncode == 0 else None
