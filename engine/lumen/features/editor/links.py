"""Names in a file that are other files: motions, stories, behaviours, words, controllers, robots, schemas."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.names import KIND_FOLDERS, NameKind
from lumen.language.diagnostics import Place
from lumen.project.messages import SCHEMA_SUFFIX


class FileLink(NamedTuple):
    """Where a file is named, and which one that is, from the project's root."""

    place: Place
    target: str


def links(analysis: Analysis, file: str) -> Iterator[FileLink]:
    """The files that are named in a file and are there."""
    for use in analysis.index.uses:
        if use.place.file == file and use.text and (folder := KIND_FOLDERS.get(use.kind)):
            target = f"{folder}/{use.name}{SCHEMA_SUFFIX if use.kind is NameKind.MESSAGE else '.yaml'}"
            if target in analysis.files:
                yield FileLink(use.place, target)
