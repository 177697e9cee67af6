"""A section of lumen.yaml: the scenes of a lamp."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.diagnostics import ERROR, Code
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields

NO_SCENE = Code("no-scene", "robot", ERROR, "the lamp begins with a scene that it does not have")

SCHEMA = {
    "description": "A lamp on the stage",
    "type": "object",
    "additionalProperties": False,
    "required": ["scenes"],
    "properties": {
        "first": {"description": "The scene at the start", "type": "string", "examples": ["night"]},
        "scenes": {
            "description": "How bright each scene is, from 0 to 1",
            "type": "object",
            "additionalProperties": {"type": "number", "minimum": 0, "maximum": 1},
            "examples": [{"night": 0.1}],
        },
    },
}


@dataclass(frozen=True)
class Lamp:
    """The scene at the start, and the brightness of each scene (0..1)."""

    first: str = ""
    scenes: Mapping[str, float] = field(default_factory=dict)


def read_lamp(data: Mapping[str, Any], report: DocumentReport) -> Lamp:
    """Return what the lamp does; a first scene that it does not have is reported."""
    lamp = read_fields(Lamp, data["lamp"])
    if lamp.first and lamp.first not in lamp.scenes:
        report(NO_SCENE, ("lamp", "first"), f"the lamp has no scene `{lamp.first}`", "add it to `scenes`")
    return lamp
