"""Links from names to the files that define them, such as motions, stories and behaviours."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.names import KIND_FOLDERS, NameKind
from lumen.language.diagnostics import Place
from lumen.project.messages import SCHEMA_SUFFIX


class FileLink(NamedTuple):
    """The place of a name, and the file that it names, relative to the project's root."""

    place: Place
    target: str


def links(analysis: Analysis, file: str) -> Iterator[FileLink]:
    """Yield links to the existing files of the project that are named in a file."""
    for use in analysis.index.uses:
        if use.place.file == file and use.text and (folder := KIND_FOLDERS.get(use.kind)):
            target = f"{folder}/{use.name}{SCHEMA_SUFFIX if use.kind is NameKind.MESSAGE else '.yaml'}"
            if target in analysis.files:
                yield FileLink(use.place, target)
