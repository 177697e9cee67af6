"""The project's folder after a rollback: the running files are written to it, and the newer versions kept elsewhere."""

import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime
from itertools import count
from pathlib import Path
from typing import NamedTuple

from lumen.project.files import Unreadable, belongs, on_disk, read_files
from lumen.project.home import home_of
from lumen.project.project_folders import FLEET_FILE
from lumen.upkeep.own_folders import private_folder

KEPT_FOLDER = "rolled-back"
"""The folder of a home with the newer versions, in one folder per rollback."""
NOT_KEPT = "the previous files are not kept"
_NEW = ".restored"


class Restored(NamedTuple):
    """The result of a restoration."""

    paths: tuple[str, ...] = ()
    """The changed paths."""
    kept: str = ""
    """The folder with the newer versions of these paths."""
    trouble: str = ""
    """Why nothing was restored; empty if there was no error."""

    def lines(self) -> list[str]:
        """Return a sentence for each file, for a person."""
        return [f"{path} is as it was before; the newer version is in {self.kept}/{path}" for path in self.paths]


def restore(root: Path, wanted: Mapping[str, bytes] | None) -> Restored:
    """Make the project's files `wanted`, all of them or none; the newer versions are saved in the home first.

    fleet.yaml and files that Lumen does not read stay the same. A newer file that `wanted` lacks is moved away. A link
    is never replaced. If `wanted` is None, or after an error, nothing is done and the result has the `trouble`.
    """
    if wanted is None:
        return Restored(trouble=NOT_KEPT)
    there = read_files(root)
    paths = tuple(
        path
        for path in sorted({*there, *wanted})
        if belongs(path) and path != FLEET_FILE and there.get(path) != wanted.get(path)
    )
    if not paths:
        return Restored()
    try:
        _check(root, paths, there)
        folder = _keep(root, {path: there[path] for path in paths if path in there})
        replace_files(root, {path: wanted.get(path) for path in paths}, there)
    except OSError as error:
        return Restored(trouble=unwritten(error))
    with suppress(ValueError):
        folder = folder.relative_to(root)
    return Restored(paths, folder.as_posix())


def _check(root: Path, paths: tuple[str, ...], there: Mapping[str, bytes]) -> None:
    """Raise OSError for the first file that is a link, or that can't be read and so can't be saved."""
    for path in paths:
        file = on_disk(root, path)
        if file.is_symlink():
            raise OSError(None, "it is a link", path)
        if isinstance(content := there.get(path), Unreadable):
            raise OSError(None, content.decode("utf-8", "replace"), path)


def _keep(root: Path, newer: Mapping[str, bytes]) -> Path:
    """Write the newer versions to a new folder of the home, and return that folder. Raises OSError."""
    folder = _new_folder(home_of(root) / KEPT_FOLDER)
    for path, content in newer.items():
        _write(folder / path, content)
    return folder


def _new_folder(kept: Path) -> Path:
    private_folder(kept)
    name = f"{datetime.now():%Y-%m-%d-%H%M%S}"
    for number in count(1):
        folder = kept / (name if number == 1 else f"{name}-{number}")
        with suppress(FileExistsError):
            folder.mkdir(mode=0o700)
            return folder
    raise AssertionError


def unwritten(error: OSError) -> str:
    """Return the sentence for a person about a file that the disk refused."""
    file = Path(error.filename).name if error.filename else "the folder"
    if file.endswith(_NEW):
        file = file.removeprefix(".").removesuffix(_NEW)
    return f"{file} can't be written: {(error.strerror or str(error)).lower()}"


def replace_files(root: Path, wanted: Mapping[str, bytes | None], there: Mapping[str, bytes]) -> None:
    """Write the `wanted` files to the project's folder, and delete those that are None.

    If one fails, all are restored from `there`, and OSError is raised. Each file is first written under another name,
    so that a full disk is noticed before any file is replaced.
    """
    files = {path: on_disk(root, path) for path in wanted}
    drafts, done = dict[str, Path](), list[str]()
    try:
        for path, content in wanted.items():
            if content is not None:
                drafts[path] = files[path].with_name(f".{files[path].name}{_NEW}")
                _write(drafts[path], content)
                with suppress(FileNotFoundError):
                    shutil.copymode(files[path], drafts[path])
        for path, file in files.items():
            done.append(path)
            if path in drafts:
                os.replace(drafts[path], file)
            else:
                file.unlink(missing_ok=True)
    except OSError:
        for path in done:
            with suppress(OSError):
                if path in there:
                    _write(files[path], there[path])
                else:
                    files[path].unlink(missing_ok=True)
        for draft in drafts.values():
            with suppress(OSError):
                draft.unlink()
        raise


def _write(file: Path, content: bytes) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "wb") as opened:
        opened.write(content)
        opened.flush()
        os.fsync(opened.fileno())
