"""The section `sprayer` of lumen.yaml."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.project.document_report import DocumentReport

SCHEMA = {
    "description": "A sprayer of scents beside the robot",
    "type": "object",
    "additionalProperties": False,
    "required": ["nozzles"],
    "properties": {
        "nozzles": {
            "description": "The scent of each nozzle",
            "type": "object",
            "additionalProperties": {"type": "string"},
            "examples": [{"left": "lavender"}],
        }
    },
}


@dataclass(frozen=True)
class Sprayer:
    """The scent of each nozzle."""

    nozzles: Mapping[str, str] = field(default_factory=dict)


def read_sprayer(data: Mapping[str, Any], report: DocumentReport) -> Sprayer:
    """Return the settings; `data` fits the schema."""
    return Sprayer(data["sprayer"]["nozzles"])
