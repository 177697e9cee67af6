"""Bundles: the files of a project in a zip. The hash of the files is the name of the bundle."""

import io
import zipfile
import zlib
from collections.abc import Mapping

from lumen.errors import LumenError

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of each file, so that the same files make the same zip."""
OWNER_ONLY = 0o600 << 16
"""The rights of each file once it is unpacked, as zip stores them."""


class DamagedBundleError(LumenError):
    """A zip that can't be read, or that unpacks to more than a project may have."""


def packed(files: Mapping[str, bytes]) -> bytes:
    """Return the files as a zip."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in sorted(files.items()):
            entry = zipfile.ZipInfo(path, EPOCH)
            entry.external_attr = OWNER_ONLY
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def unpacked(data: bytes, most: int) -> dict[str, bytes]:
    """Return the files in a zip, at most `most` bytes. Raises DamagedBundleError."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > most:
                raise DamagedBundleError("is larger than a project may be")
            return {name: archive.read(name) for name in archive.namelist()}
    # zipfile lets all of these through for damaged bytes: of its own format, of the compression, of names and flags
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError, EOFError, zlib.error):
        raise DamagedBundleError("is damaged or incomplete") from None
