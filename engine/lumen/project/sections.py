"""The sections of lumen.yaml that features add: their settings, and their part of the schema."""

import pickle
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass, replace
from enum import Enum
from functools import cache
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin

from lumen.expressions.json_schema import is_usable_alone
from lumen.feature import Section, distribution_of, resolve, rows, table
from lumen.language.diagnostics import Diagnostic
from lumen.project.broken_features import faults_reported, is_finding, shown
from lumen.project.document_report import DocumentReport

T = TypeVar("T")


def read_fields(kind: type[T], data: Mapping[str, Any], **given: Any) -> T:
    """Return an object of a dataclass, whose fields are read from the keys of their names.

    `given` are fields that the caller has read because their keys have other names or units. A field without a key, or
    with the value None, gets its default; TypeError is raised if the field has no default. The annotation of a field
    decides how its value is read:
    - An `int` is converted from any number, such as a port `8080.0`; a member of an enumeration from its value.
    - A tuple is read from a list, or from one text; a mapping from a map.
    - A dataclass is read from a map; any other value becomes its first field.
    - A dataclass that may be None is None if a key without a default is absent.
    """
    readers: Mapping[str, Callable[[Any], Any]] = _readers(kind)  # type: ignore[arg-type]  # a class is hashable
    said = {key: value for key, value in data.items() if key in readers and key not in given and value is not None}
    return kind(**{name: readers[name](value) for name, value in said.items()}, **given)


@cache
def _readers(kind: type) -> Mapping[str, Callable[[Any], Any]]:
    """Return the function that reads each field of a dataclass."""
    return {each.name: _reader(each.type) for each in fields(kind)}


def _reader(declared: Any) -> Callable[[Any], Any]:
    """Return the function that reads a value of a declared type."""
    form, inner = get_origin(declared), get_args(declared)
    if form is UnionType and inner[1:] == (type(None),):
        return _optional(inner[0]) if is_dataclass(inner[0]) else _reader(inner[0])
    if form is tuple:
        item = _reader(inner[0])
        return lambda data: (item(data),) if isinstance(data, str) else tuple(map(item, data))
    if form is Mapping:
        value = _reader(inner[1])
        return lambda data: {key: value(each) for key, each in data.items()}
    if is_dataclass(declared):
        return lambda data: _object(declared, data)
    return declared if declared is int or (isinstance(declared, type) and issubclass(declared, Enum)) else _unchanged


def _optional(kind: Any) -> Callable[[Any], Any]:
    needed = {each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING}
    return lambda data: read_fields(kind, data) if needed <= data.keys() else None


def _object(kind: Any, data: Any) -> Any:
    return read_fields(kind, data) if isinstance(data, Mapping) else kind(data)


def _unchanged(data: Any) -> Any:
    return data


def read_sections(data: Mapping[str, Any], report: DocumentReport) -> dict[str, object]:
    """Return the settings of each section in the data of lumen.yaml; those that equal their defaults are left out.

    Therefore a section that only repeats its defaults makes the same project as one that is absent. If an installed
    feature can't read its section, the fault is reported, and the section is left out.
    """
    found: dict[str, object] = {}
    for feature, (key, row) in rows("sections"):
        if not has_section(data, key):
            continue
        faults: list[Diagnostic] = []
        with faults_reported(feature, f"reading `{key}`", faults.append):
            settings = (_read_installed if distribution_of(feature) else _read)(row, data, report)
            if settings != type(settings)():
                found[key] = settings
        place = report.document.place(tuple(key.split(".")), key=True)
        report.diagnostics += (replace(fault, place=place) for fault in faults)
    return found


def is_section(key: str) -> bool:
    """Return True if a feature reads the section of this key, such as `modules.show`."""
    return key in table("sections")


def with_sections(schema: dict[str, Any]) -> dict[str, Any]:
    """Add the sections of features that the JSON Schema of lumen.yaml lacks, and return the same schema.

    A section whose own schema can't be used accepts everything, until the section is read and the fault is reported.
    """
    for feature, (key, row) in rows("sections"):
        if row.schema:
            *above, name = key.split(".")
            siblings = schema["properties"]
            for step in above:
                siblings = siblings.setdefault(step, {"type": "object"}).setdefault("properties", {})
            own: Mapping[str, Any] = {}
            with faults_reported(feature, f"the schema of `{key}`", lambda _: None):
                own = added_schema(row.schema)
            siblings.setdefault(name, own)
    return schema


def _read(row: Section, data: Mapping[str, Any], report: DocumentReport) -> object:
    """Return the settings of a section, as its feature reads them.

    Raises TypeError if the section's schema can't be used, if the settings are not a dataclass, or if their field
    `row.entries` is not a mapping. Exceptions of the feature's code are not caught.
    """
    if row.schema:
        added_schema(row.schema)
    settings: object = resolve(row.read)(data, report)
    if not is_dataclass(settings):
        raise TypeError(f"`{row.read}` returns no dataclass")
    if row.entries and not isinstance(getattr(settings, row.entries), Mapping):
        raise TypeError(f"`{row.entries}` of its settings is no mapping")
    return settings


def _read_installed(row: Section, data: Mapping[str, Any], report: DocumentReport) -> object:
    """Return the settings of a package's section, as `_read` does, and keep its findings.

    Raises TypeError if it adds anything but findings to the report, and any error of `pickle` if the settings can't be
    sent by the process that reads the files.
    """
    own = report.copy()
    settings = _read(row, data, own)
    if not isinstance(own.diagnostics, list) or not all(map(is_finding, own.diagnostics)):
        raise TypeError(f"`{row.read}` reported {shown(own.diagnostics)}, which are no findings")
    pickle.dumps(settings)
    report.take(own)
    return settings


@cache
def added_schema(where: str) -> Mapping[str, Any]:
    """Return the JSON Schema that an import string names. Raises TypeError if there is no usable one."""
    schema = resolve(where)
    if not is_usable_alone(schema):
        raise TypeError(f"`{where}` is no JSON Schema, or has `$ref`")
    return schema


def has_section(data: object, key: str) -> bool:
    """Return True if the data has the section of this key, such as `modules.show`."""
    node = data
    for step in key.split("."):
        if not isinstance(node, Mapping) or step not in node:
            return False
        node = node[step]
    return True
