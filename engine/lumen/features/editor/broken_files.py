"""Files that are temporarily invalid YAML, and findings that result only from their unreadable parts."""

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
"""The signatures of findings: code, file and message."""


class BrokenFile(NamedTuple):
    """A file that is invalid YAML."""

    diagnostics: tuple[Diagnostic, ...]
    """The findings about the file's invalid YAML."""
    readable: bytes
    """A readable replacement: the repaired text, or an earlier version of the file."""
    mended: MendedText | None
    """The repair; None if `readable` is an earlier version."""


def broken_files(files: Mapping[str, bytes], before: Mapping[str, bytes]) -> dict[str, BrokenFile]:
    """Return, by name, the invalid YAML files that can be replaced; `before` are the last readable versions."""
    return {file: found for file, content in files.items() if (found := _broken(file, content, before))}


def follows(finding: Diagnostic, broken: Mapping[str, BrokenFile], known: KnownFindings) -> bool:
    """Return True if a finding may result only from the unreadable part of a file.

    Such a finding is in or around that part, quotes a word of it, or is a new warning or hint, absent from `known`.
    """
    here = broken.get(finding.place.file)
    if here and (here.mended is None or finding.place.line - 1 in here.mended.around | here.mended.cut):
        return True
    words = frozenset(word for each in broken.values() if each.mended for word in each.mended.words)
    if not words.isdisjoint(_QUOTED.findall(finding.message)):
        return True
    return finding.severity is not Severity.ERROR and signature(finding) not in known


def signature(finding: Diagnostic) -> tuple[str, str, str]:
    """Return the code, file and message of a finding, which do not change when its line moves."""
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
    """Yield possible replacements of a file, the best first: its repaired text, then its version in `before`."""
    try:
        part = mended(file, content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        part = None
    if part:
        yield BrokenFile(found, part.text.encode("utf-8", "surrogatepass"), part)
    if file in before:
        yield BrokenFile(found, before[file], None)
