"""A behaviour without a project around it: from its file and those beside it, or from dicts."""

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from lumen.errors import ProjectError, UsageError
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.language.machines import MachineDefinition
from lumen.loading.behaviors import build_machine
from lumen.loading.complaints import MISSING_KEY
from lumen.loading.context import check_memory
from lumen.loading.document import Document
from lumen.loading.document_report import DocumentReport
from lumen.loading.files import MAX_FILE_BYTES
from lumen.loading.linking import link
from lumen.loading.plain import plain_document
from lumen.loading.regular_files import read_regular
from lumen.loading.schema import check_schema
from lumen.loading.yaml_reader import parse

ReadDocument = Callable[[str], tuple[Document | None, list[Diagnostic]]]


def machine_from_file(path: Path) -> MachineDefinition:
    """The machine in a file; what it invokes stands beside it.

    Raises UsageError where a file can't be read, ProjectError for what they say.
    """
    files = {file.stem: file for file in sorted(path.parent.glob("*.yaml"))} | {path.stem: path}

    def read(name: str) -> tuple[Document | None, list[Diagnostic]]:
        try:
            return parse(str(files[name]), read_regular(files[name], MAX_FILE_BYTES))
        except OSError as error:
            raise UsageError(f"can't read {files[name]}: {(error.strerror or str(error)).lower()}") from None

    return _Family(read, files.keys()).head(path.stem)


def machine_from_dict(data: Mapping[str, Any], name: str, behaviors: Mapping[str, Any]) -> MachineDefinition:
    """The machine that a dict of a file's shape describes; `behaviors` are those that it may invoke, by name.

    Raises ProjectError.
    """
    every = {**behaviors, name: data}
    return _Family(lambda each: plain_document(each, every[each]), every.keys()).head(name)


class _Family:
    """A behaviour, those that it invokes, and those that they invoke."""

    def __init__(self, read: ReadDocument, names: Collection[str]) -> None:
        self.read, self.names = read, names
        self.machines: dict[str, MachineDefinition] = {}
        self.reports: dict[str, DocumentReport] = {}
        self.loose: list[Diagnostic] = []

    def head(self, name: str) -> MachineDefinition:
        """The machine of that name, its family linked; raises ProjectError."""
        waiting = [name]
        while waiting:
            each = waiting.pop()
            if each in self.names and each not in self.reports:
                waiting += self.build(each)
        linked = link(self.machines, self.reports, self.names)
        found = [*self.loose, *(d for report in self.reports.values() for d in report.diagnostics)]
        if name not in linked or has_errors(found):
            raise ProjectError(found)
        return linked[name]

    def build(self, name: str) -> list[str]:
        """Build one of them; what it invokes."""
        document, diagnostics = self.read(name)
        self.loose += diagnostics
        report = self.reports[name] = DocumentReport(document or Document(name, None))
        if document is None:
            return []
        machine = build_machine(check_schema(document, "behavior", report), report, name=name)
        if machine is None:
            if not has_errors([*diagnostics, *report.diagnostics]):
                report(MISSING_KEY, (), "a behaviour needs `states`", hint="write `states:` with at least one state")
            return []
        check_memory(machine, report)
        self.machines[name] = machine
        return [invoke.behavior for state in machine.states.values() for invoke in state.invoke]
