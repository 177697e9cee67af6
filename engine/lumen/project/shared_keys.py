"""Read `shared:` of lumen.yaml as the keys that all robots of a house can read."""

from collections.abc import Mapping
from typing import Any

from lumen.expressions.json_schema import JsonSchema
from lumen.language.diagnostics import ERROR, Code, did_you_mean
from lumen.language.shared import SharedKey, SharedKeys
from lumen.project.complaints import WRONG_VALUE
from lumen.project.document_report import DocumentReport
from lumen.project.house import robot_names
from lumen.project.numbers import finite
from lumen.project.schema_messages import TYPE_NAMES

UNKNOWN_OWNER = Code("unknown-owner", "robot", ERROR, "a key of `shared` names a robot that is not in the house")

FIRST: Mapping[str, Any] = {"string": "", "number": 0, "integer": 0, "boolean": False}
"""The first value of a key without `initial` in lumen.yaml, by its type."""


def read_shared(data: Mapping[str, Any], report: DocumentReport) -> SharedKeys:
    """Return the keys of `shared`; those that can't be used are reported and left out."""
    robots, found = robot_names(data), {}
    for name, row in data["shared"].items():
        owner, kind = row["owner"], row["type"]
        initial = row.get("initial", FIRST[kind])
        if owner not in robots:
            hint = did_you_mean(owner, robots, "there are")
            report(UNKNOWN_OWNER, ("shared", name, "owner"), f"there is no robot `{owner}`", hint)
        elif not JsonSchema({"type": kind}).fits(initial):
            message, hint = (
                f"the initial value of `{name}` is {initial!r}, but should be {TYPE_NAMES[kind]}",
                f"write {TYPE_NAMES[kind]}",
            )
            report(WRONG_VALUE, ("shared", name, "initial"), message, hint)
        elif isinstance(initial, bool | str) or finite(initial, report, ("shared", name, "initial")):
            found[name] = SharedKey(owner, kind, initial)
    return SharedKeys(found)
