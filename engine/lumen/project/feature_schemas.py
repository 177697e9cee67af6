"""The additions of features to the schemas of lumen.yaml and of bodies."""

import re
from typing import Any

from lumen.feature import table

_HERE = {"$ref": "#/$defs/here"}


def add_bases(schema: dict[str, Any]) -> None:
    """Add the kinds of bases that the schema of bodies lacks, with the keys that each needs beside `kind`."""
    base = schema["properties"]["roles"]["properties"]["base"]
    kind = base["properties"]["kind"]
    for name, row in table("bases").items():
        if name not in kind["enum"]:
            kind["enum"].append(name)
            kind["description"] += f" `{name}` is {row.title}."
            speeds, wheels = ["speed", "turn"] if row.drives else [], ["left", "right"] if row.wheels else []
            then = {"required": speeds, "propertyNames": {"enum": ["kind", *speeds, *wheels]}}
            base["allOf"].append({"if": _is_kind(name), "then": then})


def _is_kind(name: str) -> dict[str, Any]:
    return {"required": ["kind"], "patternProperties": {"^kind$": {"const": name}}}


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
