"""`console:` of lumen.yaml, from its data to `ConsoleSettings`."""

from collections.abc import Mapping
from typing import Any

from lumen.features.console.settings import ConsoleSettings
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields


def read_console(data: Mapping[str, Any], report: DocumentReport) -> ConsoleSettings:
    """Return the settings in `console:`; their presence makes `lumen run` start a console in a process of its own."""
    return read_fields(ConsoleSettings, data["console"], wanted=True)
