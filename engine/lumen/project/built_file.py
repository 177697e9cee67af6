"""One file of a project, from its bytes to what is built of it: done once while it stays as it is."""

from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from lumen.language.diagnostics import Diagnostic
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.document import TOO_LARGE
from lumen.project.document_report import DocumentReport
from lumen.project.markdown import MARKDOWN_SUFFIX, parse_markdown
from lumen.project.memoization import memoize
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse

T = TypeVar("T")
B = TypeVar("B", covariant=True)


class Build(Protocol[B]):
    """Makes something of a document's checked data; what is wrong with it is reported."""

    def __call__(self, data: Any, report: DocumentReport, *, name: str) -> B | None: ...


class BuiltFile(NamedTuple, Generic[T]):
    """A document's checked data, its report, and what was built of it, None where it holds too little for that."""

    data: Any
    report: DocumentReport
    built: T | None


def read_file(
    file: str, content: bytes, kind: str, build: Build[T], around: object = None, verbs: OwnVerbs = NO_VERBS
) -> tuple[BuiltFile[T] | None, list[Diagnostic]]:
    """What a file holds, None where it can't be read at all, and what is wrong with its text.

    Its report is the caller's own, to which more may be said; all else is shared with whoever reads the same.
    `around` is what else the building depends on, `verbs` are those that the project declares.
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
    """What `build` makes; a file may nest more deeply than Python can follow."""
    try:
        return build()
    except RecursionError:
        report(TOO_LARGE, (), "the file is nested too deeply to be read", hint="use fewer levels")
        return None
