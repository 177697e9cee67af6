"""The additions of features to the schema of lumen.yaml."""

import re
from typing import Any

from lumen.feature import table

_HERE = {"$ref": "#/$defs/here"}


def add_features(schema: dict[str, Any]) -> None:
    """Add what the schema of lumen.yaml lacks: settings of modules, senses and schemes of buses."""
    properties = schema["properties"]
    known = properties["modules"]["properties"]
    for name, row in table("modules").items():
        options = {"here": _HERE, **row.options}
        kind = {"type": "object", "additionalProperties": False, "properties": options}
        known.setdefault(name, {"description": row.description, **kind})
    of = schema["$defs"]["route"]["properties"]["of"]["enum"]
    of += [sense for sense in table("senses") if sense not in of]
    bus, schemes = properties["bus"], list(table("buses"))
    if any(not re.match(bus["pattern"], f"{scheme}://") for scheme in schemes):
        bus["pattern"] = f"^({'|'.join(map(re.escape, schemes))})://"
