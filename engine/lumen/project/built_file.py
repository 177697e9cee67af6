"""Build one file of a project from its bytes; the result is cached until the file changes."""

from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from lumen.language.diagnostics import Diagnostic
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.document import TOO_LARGE
from lumen.project.document_report import DocumentReport
from lumen.project.knowledge import MARKDOWN_SUFFIX, parse_markdown
from lumen.project.memoization import memoize
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse

T = TypeVar("T")
B = TypeVar("B", covariant=True)


class Build(Protocol[B]):
    """Builds a value from a document's checked data and reports faults; returns None if no value can be built."""

    def __call__(self, data: Any, report: DocumentReport, *, name: str) -> B | None: ...


class BuiltFile(NamedTuple, Generic[T]):
    """A document's checked data, its report, and the value built from it."""

    data: Any
    report: DocumentReport
    built: T | None
    """None if the data holds too little to build a value."""


def read_file(
    file: str, content: bytes, kind: str, build: Build[T], around: object = None, verbs: OwnVerbs = NO_VERBS
) -> tuple[BuiltFile[T] | None, list[Diagnostic]]:
    """Return the built file and the findings about its text; the file is None if its text can't be parsed.

    The report is a copy that the caller may add to; everything else is shared between callers that read the same file.
    `around` is any further input of `build`; `verbs` are those that the project declares.
    """
    read, found = memoize(("file", file), (content, around, verbs), lambda: _read(file, content, kind, build, verbs))
    return read and read._replace(report=read.report.copy()), found


def _read(
    file: str, content: bytes, kind: str, build: Build[T], verbs: OwnVerbs
) -> tuple[BuiltFile[T] | None, list[Diagnostic]]:
    document, found = (parse_markdown if file.endswith(MARKDOWN_SUFFIX) else parse)(file, content)
    if document is None:
        return None, found
    report, name = DocumentReport(document), PurePosixPath(file).stem
    data = check_schema(document, kind, report, verbs)
    return BuiltFile(data, report, unless_too_deep(report, lambda: build(data, report, name=name))), found


def unless_too_deep(report: DocumentReport, build: Callable[[], T | None]) -> T | None:
    """Return the result of `build`; if the file is nested too deeply for Python, report the fault and return None."""
    try:
        return build()
    except RecursionError:
        report(TOO_LARGE, (), "the file is nested too deeply to be read", hint="use fewer levels")
        return None
