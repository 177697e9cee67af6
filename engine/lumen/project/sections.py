"""The sections of lumen.yaml that features add: their settings, and their part of the schema."""

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from functools import cache
from typing import Any

from lumen.expressions.json_schema import is_usable_alone
from lumen.feature import Section, resolve, rows, table
from lumen.language.diagnostics import Diagnostic
from lumen.project.broken_features import faults_reported
from lumen.project.document_report import DocumentReport


def read_sections(data: Mapping[str, Any], report: DocumentReport) -> dict[str, object]:
    """Return the settings of each section in the data of lumen.yaml; those that equal their defaults are left out.

    Therefore a section that only repeats its defaults makes the same project as one that is absent. If an installed
    feature can't read its section, that is reported, and the section is left out.
    """
    found: dict[str, object] = {}
    for feature, (key, row) in rows("sections"):
        if not _has(data, key):
            continue
        faults: list[Diagnostic] = []
        with faults_reported(feature, f"reading `{key}`", faults):
            settings = _read(row, data, report)
            if settings != type(settings)():
                found[key] = settings
        place = report.document.place(tuple(key.split(".")), key=True)
        report.diagnostics += (replace(fault, place=place) for fault in faults)
    return found


def is_section(key: str) -> bool:
    """Return whether a feature reads the section of this key."""
    return key in table("sections")


def with_sections(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON Schema of lumen.yaml with the sections that it lacks.

    A section whose own schema can't be used accepts everything, until it is read and that is reported.
    """
    for feature, (key, row) in rows("sections"):
        if row.schema:
            *above, name = key.split(".")
            siblings = schema["properties"]
            for step in above:
                siblings = siblings.setdefault(step, {"type": "object"}).setdefault("properties", {})
            own: Mapping[str, Any] = {}
            with faults_reported(feature, f"the schema of `{key}`", []):
                own = _schema(row.schema)
            siblings.setdefault(name, own)
    return schema


def _read(row: Section, data: Mapping[str, Any], report: DocumentReport) -> object:
    """Return the settings of a section. Raises any exception of its feature, and TypeError for another result."""
    if row.schema:
        _schema(row.schema)
    settings: object = resolve(row.read)(data, report)
    if not is_dataclass(settings):
        raise TypeError(f"`{row.read}` returns no dataclass")
    if row.entries and not isinstance(getattr(settings, row.entries), Mapping):
        raise TypeError(f"`{row.entries}` of its settings is no mapping")
    return settings


@cache
def _schema(where: str) -> Mapping[str, Any]:
    """Return the JSON Schema that an import string names. Raises TypeError if there is no usable one."""
    schema = resolve(where)
    if not is_usable_alone(schema):
        raise TypeError(f"`{where}` is no JSON Schema, or has `$ref`")
    return schema


def _has(data: Mapping[str, Any], key: str) -> bool:
    """Return whether the data has a section, by its key such as `modules.show`."""
    node: Any = data
    for step in key.split("."):
        if not isinstance(node, Mapping) or step not in node:
            return False
        node = node[step]
    return True
