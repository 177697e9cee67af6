"""Bundles: zips of a project's files, named by the hash of the files."""

import io
import zipfile
import zlib
from collections.abc import Mapping

from lumen.errors import LumenError

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of every file in a bundle, so that the same files make the same zip."""
OWNER_ONLY = 0o600 << 16
"""The file permissions after unpacking (owner only), as zip stores them."""


class DamagedBundleError(LumenError):
    """A zip that can't be read, or that unpacks to more bytes than a project may have."""


def packed(files: Mapping[str, bytes]) -> bytes:
    """Return the files as a zip; the same files always give the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in sorted(files.items()):
            entry = zipfile.ZipInfo(path, EPOCH)
            entry.external_attr = OWNER_ONLY
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def unpacked(data: bytes, most: int) -> dict[str, bytes]:
    """Return the files in a zip. Raises DamagedBundleError if it is damaged or unpacks to more than `most` bytes."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > most:
                raise DamagedBundleError("is larger than a project may be")
            return {name: archive.read(name) for name in archive.namelist()}
    # zipfile raises any of these for damaged bytes in its own format, the compressed data, the names or the flags
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError, EOFError, zlib.error):
        raise DamagedBundleError("is damaged or incomplete") from None
