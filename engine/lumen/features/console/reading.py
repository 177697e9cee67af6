"""`console:` of lumen.yaml, from its data to `ConsoleSettings`."""

from collections.abc import Mapping
from typing import Any

from lumen.features.console.settings import CONSOLE_HOST, CONSOLE_PORT, ConsoleSettings
from lumen.project.document_report import DocumentReport


def read_console(data: Mapping[str, Any], report: DocumentReport) -> ConsoleSettings:
    """Return the address of the pages and their PINs; `lumen run` then has a console beside it."""
    console = data["console"]
    return ConsoleSettings(
        wanted=True,
        port=int(console.get("port", CONSOLE_PORT)),
        host=console.get("host", CONSOLE_HOST),
        pins=dict(console.get("pins", {})),
        hosts=tuple(console.get("hosts", ())),
    )
