"""A bundle in transit: a project's files in a signed zip, named by their hash."""

import base64
import binascii
import re
from collections.abc import Mapping
from typing import Any

from lumen.errors import UsageError
from lumen.features.fleet.signing import BUNDLE, Signer, verified
from lumen.project.files import MAX_PROJECT_BYTES, belongs, fingerprint
from lumen.project.project_folders import FLEET_FILE
from lumen.run import bundles
from lumen.run.bundles import DamagedBundleError

HASH = re.compile(r"[0-9a-f]{64}")
MAX_BYTES = 12_000_000
"""The maximum size of a packed bundle [bytes]."""
PIECE = 500_000
"""The maximum size of a bundle's part in one message [bytes]."""


class BadBundleError(UsageError):
    """A bundle in a message is invalid, the wrong bundle, or without a trusted signature; the text is the reason."""


def packed(files: Mapping[str, bytes]) -> bytes:
    """Return the files as a zip, without fleet.yaml and the marks of options chosen at the start."""
    return bundles.packed({path: files[path] for path in files if path != FLEET_FILE and belongs(path)})


def messages_of(files: Mapping[str, bytes], signer: Signer) -> list[dict[str, Any]]:
    """Return the signed bundle of these files as message bodies, each with one part.

    Raises UsageError if the bundle exceeds MAX_BYTES.
    """
    hash, data = fingerprint(files), packed(files)
    if len(data) > MAX_BYTES:
        raise UsageError(
            f"the packed bundle is too large ({len(data) / 1e6:.1f} MB): at most {MAX_BYTES / 1e6:g} MB are allowed"
        )
    signature = signer.sign(BUNDLE, hash.encode())
    pieces = [data[at : at + PIECE] for at in range(0, len(data), PIECE)]
    common = {"hash": hash, "signature": signature, "parts": len(pieces)}
    return [{**common, "part": i, "zip": base64.b64encode(piece).decode()} for i, piece in enumerate(pieces)]


class BundleParts:
    """Joins the parts of one bundle at a time; parts may arrive in any order and repeatedly."""

    def __init__(self) -> None:
        self._of: tuple[str, int] = ("", 0)
        self._parts: dict[int, bytes] = {}

    def take(self, body: Any, wanted: str, key: str) -> dict[str, bytes] | None:
        """Add the part in a message's body; return the files if all parts have arrived, else None.

        Raises BadBundleError, and forgets all parts, if the bundle's hash is not `wanted`, if it is not signed by the
        owner of the public key `key`, or if it is damaged.
        """
        try:
            return self._take(body, wanted, key)
        except BadBundleError:
            self._parts = {}
            raise

    def _take(self, body: Any, wanted: str, key: str) -> dict[str, bytes] | None:
        match body:
            case {
                "hash": str(hash),
                "zip": str(text),
                "signature": str(signature),
                "part": int(part),
                "parts": int(parts),
            }:
                pass
            case _:
                raise BadBundleError("a message is not a valid bundle")
        if hash != wanted:
            raise BadBundleError(f"bundle {hash[:12]} arrived instead of {wanted[:12]}")
        if not 0 <= part < parts <= MAX_BYTES // PIECE + 1:
            raise BadBundleError(f"bundle {hash[:12]} has an invalid part: number {part} of {parts}")
        if not verified(key, BUNDLE, hash.encode(), signature):
            raise BadBundleError(f"bundle {hash[:12]} is not signed with the key in fleet.yaml")
        if self._of != (hash, parts):
            self._of, self._parts = (hash, parts), {}
        try:
            self._parts[part] = base64.b64decode(text, validate=True)
        except (ValueError, binascii.Error):
            raise BadBundleError(f"bundle {hash[:12]} is damaged") from None
        if len(self._parts) < parts:
            return None
        data, self._parts = b"".join(self._parts[i] for i in range(parts)), {}
        return unpacked(data, wanted)


def unpacked(data: bytes, wanted: str) -> dict[str, bytes]:
    """Return the files in a zip.

    Raises BadBundleError if the zip is damaged, contains a foreign file, or the files' hash is not `wanted`.
    """
    try:
        files = bundles.unpacked(data, MAX_PROJECT_BYTES)
    except DamagedBundleError as error:
        raise BadBundleError(f"bundle {wanted[:12]} {error}") from None
    if bad := next((name for name in files if name == FLEET_FILE or not _inside(name)), None):
        raise BadBundleError(f"bundle {wanted[:12]} contains `{bad[:80]}`, which is not a file of a project")
    if fingerprint(files) != wanted:
        raise BadBundleError(f"the files in bundle {wanted[:12]} do not match its hash")
    return files


def _inside(name: str) -> bool:
    """Return whether a file of that name belongs to a project and is inside the project's folder."""
    parts = name.split("/")
    return belongs(name) and "\\" not in name and not {"", ".", ".."} & {*parts} and "\0" not in name
