"""Write the data of a behaviour, or of another kind of file, as YAML text."""

import json
from collections.abc import Mapping
from typing import Any

import yaml
from yaml.representer import SafeRepresenter

from lumen.project.yaml_scalars import resolve

SCHEMA_COMMENT = "# yaml-language-server: $schema=../schemas/{kind}.schema.json\n"
MAX_FLOW_WIDTH = 90
"""The maximum number of characters of a map or a list that is written on one line."""

_HARD, _SPECIAL = frozenset('"\\\n\t'), frozenset("'!&*#:,[]{}%@`|>")
_TABLES = frozenset(
    ("on", "after", "context", "types", "events", "phrases", "answers", "lists", "properties", "renamed")
)
_TAGS = {type(None): "null", bool: "bool", int: "int", float: "float", str: "str"}


class _Dumper(yaml.SafeDumper):
    """Writes YAML 1.2: only a text that would be read as another type gets quotes, so `on` has no quotes."""

    def resolve(self, kind: Any, value: Any, implicit: Any) -> str:
        if kind is yaml.ScalarNode and implicit[0]:
            return f"tag:yaml.org,2002:{_TAGS[type(resolve(value))]}" if value else "tag:yaml.org,2002:null"
        return str(super().resolve(kind, value, implicit))  # type: ignore[no-untyped-call]

    def increase_indent(self, flow: bool = False, indentless: bool = False) -> None:
        super().increase_indent(flow, False)


def document_yaml(data: Mapping[str, Any], kind: str = "behavior") -> str:
    """Return the text of the file: states as blocks, transitions and actions on one line if they fit.

    Read again, it yields the same data.
    """
    text: str = yaml.serialize(_state(data), Dumper=_Dumper, width=116, allow_unicode=True)
    return SCHEMA_COMMENT.format(kind=kind) + text


def _state(data: Mapping[str, Any]) -> yaml.Node:
    return _mapping({key: _part(key, value) for key, value in data.items()}, flow=not data)


def _part(key: str, value: Any) -> yaml.Node:
    """Return the YAML node for the value under a key of a state."""
    if key == "states":
        return _mapping({name: _state(state or {}) for name, state in value.items()}, flow=False)
    if key in _TABLES and isinstance(value, Mapping):
        return _mapping({name: _compact(item) for name, item in value.items()}, flow=not value)
    if isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        return _sequence([_compact(item) for item in value], flow=False)
    return _compact(value)


def _compact(value: Any) -> yaml.Node:
    """Return the YAML node for a value.

    A map or list is on one line if its JSON has at most MAX_FLOW_WIDTH characters. Otherwise it is a block, to whose
    parts the same rule applies.
    """
    flow = not isinstance(value, Mapping | list) or len(json.dumps(value, ensure_ascii=False)) <= MAX_FLOW_WIDTH
    match value:
        case Mapping():
            return _mapping({key: _compact(item) for key, item in value.items()}, flow=flow or not value)
        case list():
            return _sequence([_compact(item) for item in value], flow=flow or not value)
    return _scalar(value)


def _scalar(value: Any) -> yaml.Node:
    node = SafeRepresenter().represent_data(value)
    if not (isinstance(node, yaml.ScalarNode) and isinstance(value, str) and "'" in value):
        return node
    if _HARD.isdisjoint(value) and not _SPECIAL.isdisjoint(value):
        node.style = '"'
    return node


def _mapping(parts: Mapping[str, yaml.Node], *, flow: bool) -> yaml.Node:
    pairs = [(_scalar(key), node) for key, node in parts.items()]
    return yaml.MappingNode("tag:yaml.org,2002:map", pairs, flow_style=flow)


def _sequence(parts: list[yaml.Node], *, flow: bool) -> yaml.Node:
    return yaml.SequenceNode("tag:yaml.org,2002:seq", parts, flow_style=flow)
