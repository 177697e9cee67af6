"""Build a behaviour without a project: from its file and those in its folder, or from dicts."""

from collections.abc import Callable, Collection, Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, Self

from lumen.errors import ProjectError
from lumen.expressions.own_functions import KnownFunctions
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.language.folders import FUNCTIONS_FOLDER
from lumen.language.machines import MachineDefinition
from lumen.language.words import Words
from lumen.project.behaviors import build_machine
from lumen.project.built_file import BuiltFile, read_file
from lumen.project.common_words import COMMON, COMMON_FILE, common_words
from lumen.project.complaints import MISSING_KEY
from lumen.project.context import check_memory
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.files import composed
from lumen.project.functions import FunctionFile, build_function, joined
from lumen.project.linking import link
from lumen.project.plain import parse_file, plain_document
from lumen.project.schema import check_schema
from lumen.project.words import build_words
from lumen.upkeep.garbage import gc_paused

ReadDocument = Callable[[str], tuple[Document | None, list[Diagnostic]]]


@gc_paused()
def machine_from_file(path: Path) -> MachineDefinition:
    """Return the machine in a file; behaviours that it invokes are in the same folder.

    Words files are in `words` below that folder, and functions in `functions` beside it. Raises UsageError if a file
    can't be read, ProjectError for faults of the files.
    """
    beside, words = _yaml_files(path.parent), _yaml_files(path.parent / "words")
    name, functions = composed(path.stem), _yaml_files(path.absolute().parent.parent / FUNCTIONS_FOLDER)
    shelves = _Shelf.of_files(beside | {name: path}), _Shelf.of_files(words), _Shelf.of_files(functions)
    return _Family(*shelves).head(name)


@gc_paused()
def machine_from_dict(
    data: Mapping[str, Any], name: str, behaviors: Mapping[str, Any], words: Mapping[str, Any] = MappingProxyType({})
) -> MachineDefinition:
    """Return the machine that a dict with the shape of a file describes. Raises ProjectError for its faults.

    `behaviors` are the behaviours that the machine may invoke, by name; `words` are the words files that these may
    name.
    """
    return _Family(_Shelf.of_dicts({**behaviors, name: data}), _Shelf.of_dicts(words), _Shelf.of_dicts({})).head(name)


def _yaml_files(folder: Path) -> dict[str, Path]:
    return {composed(file.stem): file for file in sorted(folder.glob("*.yaml"))}


class _Shelf(NamedTuple):
    """Documents of one kind that can be read by name."""

    read: ReadDocument
    names: Collection[str]

    @classmethod
    def of_files(cls, files: Mapping[str, Path]) -> Self:
        """Return the shelf of these files, by name; `read` raises UsageError for an unreadable one."""
        return cls(lambda name: parse_file(files[name]), files.keys())

    @classmethod
    def of_dicts(cls, dicts: Mapping[str, Any]) -> Self:
        return cls(lambda name: plain_document(name, dicts[name]), dicts.keys())


@cache
def supplied_words() -> BuiltFile[Words]:
    """Return the words that come with Lumen, for behaviours without a project."""
    read, _ = read_file(COMMON_FILE, common_words(), "words", build_words)
    assert read is not None  # a test ensures it
    return read


class _Family:
    """A behaviour and those that it invokes, at every depth.

    `words` are the words files in their folder; `functions` are the functions that they may call.
    """

    def __init__(self, behaviors: _Shelf, words: _Shelf, functions: _Shelf) -> None:
        self.read, self.names = behaviors
        self.shelf, self.words = words, dict[str, BuiltFile[Words]]()
        self.machines: dict[str, MachineDefinition] = {}
        self.reports: dict[str, DocumentReport] = {}
        self.loose: list[Diagnostic] = []
        self.functions = self.join(functions)

    def head(self, name: str) -> MachineDefinition:
        """Return the machine of that name, linked to those that it invokes. Raises ProjectError for faults."""
        waiting = [name]
        while waiting:
            each = waiting.pop()
            if each in self.names and each not in self.reports:
                waiting += self.build(each)
        linked = link(self.machines, self.reports, self.names)
        reports = [*self.reports.values(), *(file.report for file in self.words.values())]
        found = [*self.loose, *(d for r in reports for d in r.diagnostics if not r.follows(d.code, d.message))]
        if any(report.pruned for report in self.reports.values()):  # perhaps because of a broken function
            found += self.function_faults
        if name not in linked or has_errors(found):
            raise ProjectError(found)
        return linked[name]

    def build(self, name: str) -> list[str]:
        """Build one of the behaviours; return the names of those that it invokes."""
        document, diagnostics = self.read(name)
        self.loose += diagnostics
        report = self.reports[name] = DocumentReport(document or Document(name, None))
        if document is None:
            return []
        data = check_schema(document, "behavior", report)
        self.name_words(data)
        words, known = self.words, frozenset(self.shelf.names)
        if shipped := COMMON not in known:
            words, known = {**words, COMMON: supplied_words()}, known | {COMMON}
        machine = build_machine(
            data, report, name=name, words=words, known=known, shipped=shipped, functions=self.functions
        )
        if machine is None:
            if not has_errors([*diagnostics, *report.diagnostics]):
                report(MISSING_KEY, (), "a behaviour needs `states`", hint="write `states:` with at least one state")
            return []
        check_memory(machine, report)
        self.machines[name] = machine
        return [invoke.behavior for state in machine.states.values() for invoke in state.invoke]

    def join(self, shelf: _Shelf) -> KnownFunctions:
        """Return all functions; the faults of a function count only if the behaviours call it."""
        read, faults = dict[str, BuiltFile[FunctionFile]](), list[Diagnostic]()
        for name in shelf.names:
            document, diagnostics = shelf.read(name)
            faults += diagnostics
            if document is not None:
                report = DocumentReport(document)
                data = check_schema(document, "function", report)
                read[name] = BuiltFile(data, report, build_function(data, report, name=name))
        _, known = joined(read, frozenset(shelf.names))
        self.function_faults = [*faults, *(d for file in read.values() for d in file.report.diagnostics)]
        return known

    def name_words(self, data: Any) -> None:
        """Build the words files that a behaviour names."""
        written = data.get("words") if isinstance(data, Mapping) else None
        for name in [written] if isinstance(written, str) else written or ():
            if name in self.shelf.names and name not in self.words:
                document, diagnostics = self.shelf.read(name)
                self.loose += diagnostics
                if document is not None:
                    report = DocumentReport(document)
                    data = check_schema(document, "words", report)
                    self.words[name] = BuiltFile(data, report, build_words(data, report, name=name))
