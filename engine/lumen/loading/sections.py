"""The sections of lumen.yaml that features add: their settings, and their part of the schema."""

from collections.abc import Mapping
from functools import reduce
from typing import Any

from lumen.feature import resolve, rows
from lumen.loading.document_report import DocumentReport


def read_sections(data: Mapping[str, Any], report: DocumentReport) -> dict[str, object]:
    """Return the settings of each section in the data of lumen.yaml; those that equal their defaults are left out.

    Therefore a section that only repeats its defaults makes the same project as one that is absent.
    """
    found: dict[str, object] = {}
    for _, (key, row) in rows("sections"):
        if _has(data, key):
            settings = resolve(row.read)(data, report)
            if settings != type(settings)():
                found[key] = settings
    return found


def is_section(key: str) -> bool:
    """Return whether a feature reads the section of this key."""
    return any(key == each for _, (each, _) in rows("sections"))


def with_sections(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON Schema of lumen.yaml with the sections that it lacks."""
    for _, (key, row) in rows("sections"):
        if row.schema:
            *above, name = key.split(".")
            parent = reduce(lambda node, step: node["properties"][step], above, schema)
            parent["properties"].setdefault(name, resolve(row.schema))
    return schema


def _has(data: Mapping[str, Any], key: str) -> bool:
    """Return whether the data has a section, by its key such as `modules.show`."""
    node: Any = data
    for step in key.split("."):
        if not isinstance(node, Mapping) or step not in node:
            return False
        node = node[step]
    return True
