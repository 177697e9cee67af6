"""The bundles that a robot or a centre keeps, each as a file called by its hash."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from lumen.features.fleet.bundle import HASH, BadBundleError, packed, unpacked
from lumen.project.files import fingerprint
from lumen.upkeep.private_folder import private_folder, write_private
from lumen.upkeep.regular_files import read_regular

MAX_FILE = 40_000_000


class BundleFolder:
    """Bundles in a folder, which is made when the first one comes. Nothing that a disk does raises."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def keep(self, files: Mapping[str, bytes]) -> str:
        """Write the files as a whole or not at all; return why that is impossible, empty if it is done.

        A file of that name that is damaged is replaced.
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
        """The files of that bundle, None where they are not there as they were."""
        if not HASH.fullmatch(hash):
            return None
        try:
            return unpacked(read_regular(self._path(hash), MAX_FILE, follow=False), hash)
        except (OSError, BadBundleError):
            return None

    def hashes(self) -> list[str]:
        """Those that are kept, the newest last."""
        with suppress(OSError):
            found = sorted(self.folder.glob("*.zip"), key=lambda path: path.stat().st_mtime)
            return [path.stem for path in found if HASH.fullmatch(path.stem)]
        return []

    def prune(self, wanted: Iterable[str]) -> None:
        """Delete all but these."""
        for hash in {*self.hashes()} - {*wanted}:
            with suppress(OSError):
                self._path(hash).unlink()

    def _path(self, hash: str) -> Path:
        return self.folder / f"{hash}.zip"
