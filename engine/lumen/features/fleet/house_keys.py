"""The lumen.yaml of a bundle, adapted to a house: the house's own keys stay."""

import re
from collections.abc import Mapping

from lumen.errors import UsageError
from lumen.feature import table
from lumen.project.files import belongs
from lumen.project.project_folders import MAIN_FILE

HOUSE_KEYS = (
    "house", "robot", "robots", "hall", "stage", "units", "bus", "aliases", "timezone", "modules",
)  # fmt: skip
"""The keys of lumen.yaml about a house and its robots, besides those of features: bundles never change them."""

_BLOCK = re.compile(r"^(?=[^\s#])", re.MULTILINE)
_KEY = re.compile(r"""["']?([\w-]+)["']?\s*:""")


def fitted(bundle: Mapping[str, bytes], here: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files of a bundle, adapted to a house that runs the files `here`. Raises UsageError."""
    return {**as_started(bundle, here), MAIN_FILE: at_home(bundle.get(MAIN_FILE, b""), here.get(MAIN_FILE, b""))}


def as_started(files: Mapping[str, bytes], here: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files with the choices made when `here` was started, such as --model."""
    return {**files, **{path: mark for path, mark in here.items() if not belongs(path)}}


def at_home(shared: bytes, own: bytes) -> bytes:
    """Return a bundle's lumen.yaml with the house's own keys in place of the bundle's.

    Raises UsageError if one of them does not have its top-level keys at the left edge.
    """
    of_house = {*HOUSE_KEYS, *(key.partition(".")[0] for key, row in table("sections").items() if row.of_house)}
    ours = {key: text for key, text in _blocks(own) if key in of_house}
    kept = [text for key, text in _blocks(shared) if key not in of_house]
    ended = [text if text.endswith("\n") else f"{text}\n" for text in (*kept, *ours.values())]
    return "".join(ended).encode()


def _blocks(content: bytes) -> list[tuple[str, str]]:
    """Return the top-level keys with their texts; the text before the first key has the key ""."""
    try:
        parts = _BLOCK.split(content.decode().replace("\r\n", "\n"))
    except UnicodeDecodeError:
        raise UsageError("lumen.yaml is not UTF-8") from None
    found = []
    for part in filter(None, parts):
        key = _KEY.match(part)
        if key is None and not part.startswith("#") and part.strip():
            raise UsageError(f"lumen.yaml: a key is expected at the left edge, not `{part[:20].strip()}`")
        found.append((key.group(1) if key else "", part))
    return found
