"""The settings of modules that features add, in the schema of lumen.yaml."""

from typing import Any

from lumen.feature import table

_HERE = {"$ref": "#/$defs/here"}


def add_modules(schema: dict[str, Any]) -> None:
    """Add the settings of each module that the schema of lumen.yaml does not have yet."""
    known = schema["properties"]["modules"]["properties"]
    for name, row in table("modules").items():
        options = {"here": _HERE, **row.options}
        kind = {"type": "object", "additionalProperties": False, "properties": options}
        known.setdefault(name, {"description": row.description, **kind})
