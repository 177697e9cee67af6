"""The file guests.yaml beside lumen.yaml: the visitors who are expected, by their names."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, Code
from lumen.project.document_report import DocumentReport

TWO_HOSTS = Code("two-hosts", "names", ERROR, "more than one guest is the host")

SCHEMA = {
    "title": "Guests",
    "description": "The visitors who are expected",
    "type": "object",
    "additionalProperties": {
        "type": "object",
        "additionalProperties": False,
        "properties": {
            "age": {"description": "How old the guest is [years]", "type": "integer", "minimum": 0},
            "host": {"description": "True for the guest who invites the others", "type": "boolean"},
        },
    },
}


def build_guests(data: Any, report: DocumentReport, *, name: str) -> Mapping[str, int] | None:
    """Return the ages of the guests by their names; a second host is reported."""
    if not isinstance(data, Mapping):
        return None
    hosts = [guest for guest, about in data.items() if about.get("host")]
    for guest in hosts[1:]:
        report(TWO_HOSTS, (guest, "host"), f"`{hosts[0]}` in {name}.yaml is the host already", "delete one `host`")
    return {guest: about.get("age", 0) for guest, about in data.items()}
