"""What features add to the schema of lumen.yaml."""

import re
from typing import Any

from lumen.feature import table

_HERE = {"$ref": "#/$defs/here"}


def add_features(schema: dict[str, Any]) -> None:
    """Add the settings of each module and the scheme of each bus that the schema of lumen.yaml does not have yet."""
    properties = schema["properties"]
    known = properties["modules"]["properties"]
    for name, row in table("modules").items():
        options = {"here": _HERE, **row.options}
        kind = {"type": "object", "additionalProperties": False, "properties": options}
        known.setdefault(name, {"description": row.description, **kind})
    bus, schemes = properties["bus"], list(table("buses"))
    if any(not re.match(bus["pattern"], f"{scheme}://") for scheme in schemes):
        bus["pattern"] = f"^({'|'.join(map(re.escape, schemes))})://"
