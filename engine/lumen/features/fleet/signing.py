"""Signatures (ed25519, RFC 8032) by which robots decide whose bundles and orders to accept."""

import base64
import binascii
import os
from pathlib import Path
from typing import Any

from lumen.errors import UsageError
from lumen.extras import demand

BUNDLE, ORDER = b"lumen bundle\n", b"lumen order\n"
"""The prefixes of signed data: a bundle's signature is not valid for an order, nor the reverse."""


def generate(file: Path) -> str:
    """Write a new private key, readable only by its owner; return the public key in base64.

    Raises UsageError if the file exists or can't be written.
    """
    keys = _ed25519()
    key = keys.Ed25519PrivateKey.generate()
    text = base64.b64encode(key.private_bytes_raw())
    try:
        handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise UsageError(f"{file} already exists and is not replaced: robots may trust this key") from None
    except OSError as error:
        raise UsageError(f"{file} can't be written: {error.strerror}") from None
    with open(handle, "wb") as opened:
        opened.write(text + b"\n")
    return base64.b64encode(key.public_key().public_bytes_raw()).decode()


class Signer:
    """Signs with the private key in a file; `public` is the public key in base64.

    Raises UsageError if the file can't be read or contains no valid key.
    """

    def __init__(self, file: Path) -> None:
        keys = _ed25519()
        try:
            self._key = keys.Ed25519PrivateKey.from_private_bytes(base64.b64decode(file.read_bytes(), validate=False))
        except OSError as error:
            raise UsageError(f"{file} can't be read: {error.strerror}; `lumen fleet keygen` makes a key") from None
        except (ValueError, binascii.Error):
            raise UsageError(f"{file} contains no private key: `lumen fleet keygen` makes one") from None
        self.public = base64.b64encode(self._key.public_key().public_bytes_raw()).decode()

    def sign(self, kind: bytes, data: bytes) -> str:
        """Return the signature of `kind` followed by `data`, in base64; `kind` is `BUNDLE` or `ORDER`."""
        return base64.b64encode(self._key.sign(kind + data)).decode()


def verified(public: str, kind: bytes, data: bytes, signature: str) -> bool:
    """Return whether this public key's owner signed the data as `kind`; False for an invalid key or signature."""
    keys = _ed25519()
    try:
        key = keys.Ed25519PublicKey.from_public_bytes(base64.b64decode(public, validate=True))
        key.verify(base64.b64decode(signature, validate=True), kind + data)
    except (ValueError, binascii.Error, _invalid()):
        return False
    return True


def _ed25519() -> Any:
    demand("fleet", "a fleet", "cryptography")
    from cryptography.hazmat.primitives.asymmetric import ed25519  # needed only to sign or verify

    return ed25519


def _invalid() -> type[Exception]:
    from cryptography.exceptions import InvalidSignature

    return InvalidSignature
