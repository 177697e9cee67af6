"""Data of events: one sample for each case that the guards distinguish, derived from the guards themselves."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from math import prod
from types import MappingProxyType
from typing import Any

from lumen.expressions.kinds import FaultError
from lumen.expressions.phrases import phrases_of
from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FunctionCall,
    ListLiteral,
    Literal,
    children,
    path_of,
    walk,
)
from lumen.language.json_paths import schema_at, value_at, with_value
from lumen.language.machines import MachineDefinition
from lumen.language.numbers import is_number

MAX_FIELD_COMBINATIONS = 300
"""The maximum number of combinations of fields that are tried."""

SAMPLE_TEXT = "Ani"
"""A text for fields whose guards mention none."""

FieldPath = tuple[str, ...]
"""The keys that lead to a field of an event's data."""


def samples(
    machine: MachineDefinition,
    schema: Any,
    trees: Iterable[ExpressionNode],
    context: Mapping[str, Any],
    more: Mapping[FieldPath, Iterable[Any]] = MappingProxyType({}),
) -> Iterator[Any]:
    """Yield data of an event that fits a JSON Schema, with all mentioned values of every field that the trees read.

    The plainest data come first. `context` is the behaviour's context; `more` has further values of fields.
    """
    values: dict[FieldPath, dict[Any, None]] = {path: dict.fromkeys(found) for path, found in more.items()}
    for tree in trees:
        for path, found in _mentioned(machine, tree, context):
            values.setdefault(path, {}).update(dict.fromkeys(found))
    for path, mentioned in values.items():
        values[path] = {**dict.fromkeys(_plain(schema_at(schema, path))), **mentioned}
    base = example(schema)
    for chosen in _chosen([list(found) for found in values.values()]):
        data = base
        for path, value in zip(values, chosen, strict=True):
            data = with_value(data, path, value)
        yield data


def _chosen(columns: list[list[Any]]) -> Iterator[tuple[Any, ...]]:
    """Yield every combination of values; if there are more than `MAX_FIELD_COMBINATIONS`, every value once."""
    if prod(map(len, columns)) <= MAX_FIELD_COMBINATIONS:
        yield from product(*columns)
        return
    first = tuple(column[0] for column in columns)
    for i, column in enumerate(columns):
        yield from ((*first[:i], value, *first[i + 1 :]) for value in column)


def example(schema: Any) -> Any:
    """Return a plain value that fits a JSON Schema; an empty map if `schema` is not one."""
    if not isinstance(schema, Mapping):
        return {}
    shown = next(iter(schema.get("examples") or ()), None)
    if schema.get("properties") or schema.get("type") == "object":
        fields, given = schema.get("properties") or {}, shown if isinstance(shown, Mapping) else {}
        return {k: given[k] if k in given else example(fields.get(k)) for k in schema.get("required", ())}
    return next(iter(_plain(schema))) if shown is None else shown


def _plain(schema: Any) -> list[Any]:
    """Return some plain values that fit a field's schema."""
    if not isinstance(schema, Mapping) or not schema:
        return [SAMPLE_TEXT, "", 0, True]
    if "const" in schema:
        return [schema["const"]]
    if schema.get("enum"):
        return list(schema["enum"])
    declared = schema.get("type", ())
    kinds = [declared] if isinstance(declared, str) else list(declared)
    return [value for kind in kinds for value in _of_kind(kind, schema)] or [SAMPLE_TEXT]


def _of_kind(kind: str, schema: Mapping[str, Any]) -> list[Any]:
    least = schema.get("minimum", 0)
    plain: Mapping[str, list[Any]] = {
        "string": [SAMPLE_TEXT, ""] if not schema.get("minLength") else [SAMPLE_TEXT],
        "integer": [least, least + 1],
        "number": [least, least + 1],
        "boolean": [True, False],
    }
    return plain.get(kind, [None])


def _mentioned(
    machine: MachineDefinition, tree: ExpressionNode, context: Mapping[str, Any]
) -> Iterator[tuple[FieldPath, list[Any]]]:
    """Yield each field of the event's data in the tree, with values that it is compared with."""
    yield from ((path, []) for path in _fields(tree))
    for node, _ in walk(tree):
        match node:
            case FunctionCall(function=function, arguments=(first, Literal(value=str() as text))):
                found = texts_for(machine, function, text)
                yield from ((path, found) for path in _fields(first))
            case FunctionCall(function="heard", arguments=(first, second)):
                found = phrases_at(path_of(second), context)
                yield from ((path, found) for path in _fields(first))
            case Binary(left=left, right=right):
                for one, other in ((left, right), (right, left)):
                    sized = any(isinstance(n, FunctionCall) and n.function == "size" for n, _ in walk(one))
                    found = _compared(other, context, sized=sized)
                    yield from ((path, found) for path in _fields(one))


def texts_for(machine: MachineDefinition, function: str, text: str) -> list[Any]:
    """Return texts for which a function with that second argument returns different results."""
    match function:
        case "heard":
            return [phrase for texts in machine.phrases.get(text, {}).values() for phrase in texts]
        case "lookup":
            rows = machine.answers.get(text, ())
            return [phrase for row in rows for texts in row.phrases.values() for phrase in texts[:1]]
        case "after":
            return [text, f"{text} {SAMPLE_TEXT}"]
        case "contains" | "matches":
            return [text.strip("^$")]
    return []


def phrases_at(path: tuple[str, ...] | None, context: Mapping[str, Any]) -> list[Any]:
    """Return phrases at a path of the context, the first of each language."""
    value = _in_context(path, context)
    try:
        return [text for texts in phrases_of(value).values() for text in texts[:1]] if value else []
    except FaultError:
        return []


def _in_context(path: tuple[str, ...] | None, context: Mapping[str, Any]) -> Any:
    """Return the value at a path that begins with `context`; None for any other path."""
    return value_at(context, path[1:]) if path and path[0] == "context" else None


def _compared(other: ExpressionNode, context: Mapping[str, Any], *, sized: bool) -> list[Any]:
    items = other.items if isinstance(other, ListLiteral) else (other,)
    found: list[Any] = []
    for item in items:
        value = item.value if isinstance(item, Literal) else _in_context(path_of(item), context)
        if isinstance(item, Literal) or isinstance(value, str | int | float):
            if sized and isinstance(value, int):
                found += [" ".join([SAMPLE_TEXT] * n) for n in (value, value + 1) if 0 <= n < 50]
            elif is_number(value):
                found += [value, value - 1, value + 1]
            else:
                found.append(value)
    return found


def _fields(tree: ExpressionNode) -> Iterator[FieldPath]:
    """Yield the fields of the event's data in a tree, each as a whole path."""
    path = _field(tree)
    if path is not None:
        yield path
        return
    for child in children(tree):
        yield from _fields(child)


def _field(node: ExpressionNode) -> FieldPath | None:
    path = path_of(node)
    return path[2:] if path and path[:2] == ("event", "data") else None
