"""Files that are no YAML for a moment: what of them can be read, and which findings only follow from what can't."""

import re
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath
from typing import NamedTuple

from lumen.features.editor.mending import MendedText, mended
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.project.files import Unreadable
from lumen.project.project_folders import kind_of
from lumen.project.yaml_reader import parse

_QUOTED = re.compile(r"[^`.#]+(?=[`.])")

KnownFindings = frozenset[tuple[str, str, str]]
"""Findings by code, file and message."""


class BrokenFile(NamedTuple):
    """A file that is no YAML: what is said of that, and what stands for it; `mended` is None where that is older."""

    diagnostics: tuple[Diagnostic, ...]
    readable: bytes
    mended: MendedText | None


def broken_files(files: Mapping[str, bytes], before: Mapping[str, bytes]) -> dict[str, BrokenFile]:
    """Those of the files that can't be read; `before` is what they were when they could."""
    return {file: found for file, content in files.items() if (found := _broken(file, content, before))}


def follows(finding: Diagnostic, broken: Mapping[str, BrokenFile], known: KnownFindings) -> bool:
    """Whether a finding may only say that a part of a file can't be read; `known` are those from before that."""
    here = broken.get(finding.place.file)
    if here and (here.mended is None or finding.place.line - 1 in here.mended.around | here.mended.cut):
        return True
    words = frozenset(word for each in broken.values() if each.mended for word in each.mended.words)
    if not words.isdisjoint(_QUOTED.findall(finding.message)):
        return True
    return finding.severity is not Severity.ERROR and signature(finding) not in known


def signature(finding: Diagnostic) -> tuple[str, str, str]:
    """What stays of a finding when lines are written above it."""
    return finding.code, finding.place.file, finding.message


def _broken(file: str, content: bytes, before: Mapping[str, bytes]) -> BrokenFile | None:
    if not kind_of(file) or PurePosixPath(file).suffix != ".yaml" or isinstance(content, Unreadable):
        return None
    document, found = parse(file, content)
    if document is not None or not content.strip():
        return None
    return next(_readings(file, content, before, tuple(found)), None)


def _readings(
    file: str, content: bytes, before: Mapping[str, bytes], found: tuple[Diagnostic, ...]
) -> Iterator[BrokenFile]:
    """What could stand for a file, the best first."""
    try:
        part = mended(file, content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        part = None
    if part:
        yield BrokenFile(found, part.text.encode("utf-8", "surrogatepass"), part)
    if file in before:
        yield BrokenFile(found, before[file], None)
