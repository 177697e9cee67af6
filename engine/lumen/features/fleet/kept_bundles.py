"""The bundles that a robot or a centre keeps, each in a file named by its hash."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from lumen.features.fleet.bundle import HASH, BadBundleError, packed, unpacked
from lumen.project.files import fingerprint
from lumen.upkeep.own_folders import private_folder, write_private
from lumen.upkeep.regular_files import read_regular

MAX_FILE = 40_000_000


class BundleFolder:
    """Bundles in a folder, which is created with the first one. Errors of the disk never raise."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def keep(self, files: Mapping[str, bytes]) -> str:
        """Write the files of a bundle, all or nothing; return the error, else an empty text.

        A damaged file of that name is replaced.
        """
        hash = fingerprint(files)
        if self.files(hash) is not None:
            return ""
        try:
            private_folder(self.folder)
            write_private(self._path(hash), packed(files), durable=True)
        except OSError as error:
            return (error.strerror or str(error)).lower()
        return ""

    def files(self, hash: str) -> dict[str, bytes] | None:
        """Return the files of that bundle, None if they are missing or damaged."""
        if not HASH.fullmatch(hash):
            return None
        try:
            return unpacked(read_regular(self._path(hash), MAX_FILE, follow=False), hash)
        except (OSError, BadBundleError):
            return None

    def hashes(self) -> list[str]:
        """Return the hashes of the kept bundles, the newest last."""
        with suppress(OSError):
            found = sorted(self.folder.glob("*.zip"), key=lambda path: path.stat().st_mtime)
            return [path.stem for path in found if HASH.fullmatch(path.stem)]
        return []

    def prune(self, wanted: Iterable[str]) -> None:
        """Delete all bundles but these."""
        for hash in {*self.hashes()} - {*wanted}:
            with suppress(OSError):
                self._path(hash).unlink()

    def _path(self, hash: str) -> Path:
        return self.folder / f"{hash}.zip"
