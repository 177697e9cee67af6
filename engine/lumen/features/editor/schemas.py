"""A node's keys, values and description from the JSON Schema of its kind of file."""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.project_folders import file_kinds
from lumen.project.schema import MAX_SCHEMAS, load_schema

_SAME = ("allOf", "anyOf", "oneOf")
_BRANCHES = ("then", "else", "$ref")


@lru_cache(maxsize=MAX_SCHEMAS)
def _root(kind: str, verbs: OwnVerbs) -> Mapping[str, Any]:
    return load_schema(kind, verbs) if kind in file_kinds() else {}


def schemas_at(kind: str, path: NodePath, verbs: OwnVerbs = NO_VERBS) -> list[Mapping[str, Any]]:
    """Return all schemas that can apply to the node at a path, from all branches, the nearest first.

    `verbs` are the verbs that the project declares.
    """
    root = _root(kind, verbs)
    found = list(_here(root, root))
    for step in path:
        found = [inner for schema in found for child in _children(schema, step) for inner in _here(child, root)]
    return found


def keys_at(kind: str, path: NodePath, verbs: OwnVerbs = NO_VERBS) -> dict[str, Mapping[str, Any]]:
    """Return the possible keys of a map at a path, each with its schema."""
    found: dict[str, Mapping[str, Any]] = {}
    for schema in schemas_at(kind, path, verbs):
        for name, inner in schema.get("properties", {}).items():
            if isinstance(inner, dict):
                found.setdefault(name, inner)
    return found


def values_at(kind: str, path: NodePath, verbs: OwnVerbs = NO_VERBS) -> list[str]:
    """Return the values that the schemas list for the node at a path, as they are written in YAML."""
    values: list[str] = []
    for schema in schemas_at(kind, path, verbs):
        values += map(_written, schema.get("enum", ()))
        if schema.get("type") == "boolean":
            values += ["true", "false"]
    return list(dict.fromkeys(values))


def description_at(kind: str, path: NodePath, verbs: OwnVerbs = NO_VERBS) -> str:
    """Return the schemas' description of a node, with its default if any; empty if there is no description."""
    schemas = schemas_at(kind, path, verbs)
    text = next((s["description"] for s in schemas if "description" in s), "")
    default = next((s["default"] for s in schemas if "default" in s), None)
    return f"{text} Default: `{default}`." if text and default is not None else text


def _written(value: Any) -> str:
    return "null" if value is None else str(value).lower() if isinstance(value, bool) else str(value)


def _here(schema: Any, root: Mapping[str, Any], depth: int = 0) -> Iterator[Mapping[str, Any]]:
    """Yield a schema and all schemas that it combines or refers to."""
    if not isinstance(schema, dict) or depth > 8:
        return
    yield schema
    for keyword in _BRANCHES:
        inner = schema.get(keyword)
        if isinstance(inner, str):
            inner = root.get("$defs", {}).get(inner.removeprefix("#/$defs/"))
        yield from _here(inner, root, depth + 1)
    for keyword in _SAME:
        for inner in schema.get(keyword, ()):
            yield from _here(inner, root, depth + 1)


def _children(schema: Mapping[str, Any], step: str | int) -> Iterator[Any]:
    if isinstance(step, int):
        yield schema.get("items")
    elif step in schema.get("properties", {}):
        yield schema["properties"][step]
    else:
        yield schema.get("additionalProperties")
