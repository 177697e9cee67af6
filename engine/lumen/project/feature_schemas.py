"""The additions of features to the schemas of lumen.yaml and of bodies."""

import re
from collections.abc import Iterator
from typing import Any

from lumen.expressions.json_schema import is_usable_alone
from lumen.feature import Feature, ModuleRow, rows, table

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
    """Add what the schema of lumen.yaml lacks: settings of modules, senses and schemes of buses.

    An option of a module whose own schema can't be used accepts everything; `faulty_options` lists these.
    """
    properties = schema["properties"]
    known = properties["modules"]["properties"]
    for name, row in table("modules").items():
        faulty = _faulty_options(row)
        own = {option: {} if option in faulty else schema for option, schema in row.options.items()}
        kind = {"type": "object", "additionalProperties": False, "properties": {"here": _HERE, **own}}
        known.setdefault(name, {"description": row.description, **kind})
    of = schema["$defs"]["route"]["properties"]["of"]["enum"]
    of += [sense for sense in table("senses") if sense not in of]
    bus, schemes = properties["bus"], list(table("buses"))
    if any(not re.match(bus["pattern"], f"{scheme}://") for scheme in schemes):
        bus["pattern"] = f"^({'|'.join(map(re.escape, schemes))})://"


def faulty_options() -> Iterator[tuple[Feature, str]]:
    """Yield the feature and the fault of each module's option whose schema can't be used."""
    for feature, (name, row) in rows("modules"):
        for option in _faulty_options(row):
            yield (
                feature,
                f"the schema of the option `{option}` of its module `{name}` is no JSON Schema, or has `$ref`",
            )


def _faulty_options(row: ModuleRow) -> list[str]:
    return [option for option, schema in row.options.items() if not is_usable_alone(schema)]
