"""The reader of the section `console:` of lumen.yaml."""

from collections.abc import Mapping
from typing import Any

from lumen.features.console.settings import ConsoleSettings
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields


def read_console(data: Mapping[str, Any], report: DocumentReport) -> ConsoleSettings:
    """Return the settings in `console:`, whose presence makes `lumen run` start a console in a separate process."""
    return read_fields(ConsoleSettings, data["console"], wanted=True)
