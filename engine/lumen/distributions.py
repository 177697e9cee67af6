"""Installed distributions that add features to Lumen: those with an entry point in the group `lumen.features`.

Their metadata is read as the packaging specifications describe it. `importlib.metadata` would take 70 ms of processor
time at every start, and import some forty modules of Python.
"""

import os
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from typing import NamedTuple

GROUP = "lumen.features"
_METADATA = (".dist-info", ".egg-info")
_SECTION = rf"(?m)^\[\s*{re.escape(GROUP)}\s*\]$([^\[]*)"
_ENTRY_POINT = r"(?m)^\s*[^#;=\s][^=]*=\s*(?P<manifest>[^\s\[][^\n\[]*)"
_CODE = r"(?m)^\"?([^\W\d]\w*)(?:/[^,]*)?\.py\"?(?:,|$)"


class Distribution(NamedTuple):
    """A distribution, and the import string of one manifest of it.

    `packages` are the distribution's top-level packages and modules.
    """

    name: str
    version: str
    manifest: str
    packages: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.name} {self.version}"


@cache
def distributions() -> tuple[Distribution, ...]:
    """Return the distributions with features on the import path, by name; one with two manifests comes twice."""
    first: dict[str, list[Distribution]] = {}
    for metadata in metadata_folders():
        if found := list(_described(metadata)):
            first.setdefault(re.sub(r"[-_.]+", "-", found[0].name).lower(), found)
    return tuple(each for _, found in sorted(first.items()) for each in found)


def metadata_folders() -> Iterator[str]:
    """Iterate over the metadata folders of all distributions on the import path, in its order."""
    for folder in dict.fromkeys(sys.path):
        with suppress(OSError), os.scandir(folder or ".") as entries:  # it may be missing, or an archive
            yield from sorted(entry.path for entry in entries if entry.name.endswith(_METADATA))


def _described(metadata: str) -> Iterator[Distribution]:
    declared = _text(metadata, "entry_points.txt")
    if GROUP in declared and (section := re.search(_SECTION, declared)):
        about = _text(metadata, "METADATA") or _text(metadata, "PKG-INFO")
        headers = dict(line.split(": ", 1) for line in about.partition("\n\n")[0].splitlines() if ": " in line)
        code = re.findall(_CODE, _text(metadata, "RECORD"))
        for entry in sorted(re.findall(_ENTRY_POINT, section[1])):
            manifest = re.sub(r"\s", "", entry)
            packages = tuple(sorted({re.split(r"[.:]", manifest)[0], *code}))
            yield Distribution(headers.get("Name", metadata), headers.get("Version", ""), manifest, packages)


def _text(folder: str, name: str) -> str:
    """Return the text of a file of metadata, or an empty one if the file is missing."""
    try:
        with open(os.path.join(folder, name), "rb", buffering=0) as file:
            return file.read().decode(errors="replace").replace("\r\n", "\n")
    except OSError:
        return ""
