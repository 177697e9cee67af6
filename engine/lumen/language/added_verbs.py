"""The verbs that features and files of a project add: their rows, the schemas of their arguments, and their results."""

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any, Protocol, runtime_checkable

from lumen.feature import VerbRow, table
from lumen.language.commands import BodyCommand, Do
from lumen.language.diagnostics import NodePath
from lumen.language.events import RESULT

UNUSABLE = VerbRow("")
"""The row of a verb whose file is faulty. Behaviours may use it with any data: only the file's fault is reported."""


@runtime_checkable
class PerformedByModule(Protocol):
    """The details of a row (`VerbRow.details`) whose verb a module may perform, over the bus."""

    @property
    def module(self) -> str:
        """The name of the module; empty if another program performs the verb."""
        ...


@cache
def added_verbs() -> Mapping[str, VerbRow]:
    """Return the verbs of all features by name."""
    return table("verbs")


def added_row(command: Do) -> VerbRow | None:
    """Return the row of a command's verb: the project's own row, else a feature's; None if no feature has the verb."""
    return command.row or added_verbs().get(command.skill)


def argument_schema(row: VerbRow) -> dict[str, Any]:
    """Return the JSON Schema of the arguments. It refuses unnamed arguments unless the row's schema allows them."""
    return {"additionalProperties": False, **row.arguments, "type": "object"}


def written_schema(row: VerbRow) -> dict[str, Any]:
    """Return the JSON Schema of the verb's data in the YAML: a map of its arguments, or the short form.

    The short form is the value of `short_argument`; for a verb that needs no arguments, it is null or true.
    """
    if row == UNUSABLE:
        return {}
    whole, short = argument_schema(row), short_argument(row)
    about = {"description": row.description} if row.description else {}
    if not row.arguments.get("properties"):
        return {**about, "enum": [None, True]}
    if short:
        return {**about, "if": {"type": "object"}, "then": whole, "else": row.arguments["properties"][short]}
    if not row.arguments.get("required"):
        return {**about, "if": {"type": "object"}, "then": whole, "else": {"enum": [None, True]}}
    return {**whole, **about}


def short_argument(row: VerbRow) -> str:
    """Return the name of the argument whose value can be written alone, as in `blink: 3`; else an empty text.

    It is the only required argument, if its schema has a type other than `object`.
    """
    required, properties = row.arguments.get("required", ()), _properties(row.arguments)
    only = required[0] if len(required) == 1 else ""
    return only if only in properties and properties[only].get("type") not in (None, "object") else ""


def arguments_of(row: VerbRow, data: Any) -> dict[str, Any]:
    """Return the arguments in the verb's YAML data, with defaults for absent ones, in the order of the schema."""
    all = {**_defaults(row.arguments), **given_arguments(row, data)}
    order = [name for name in row.arguments.get("properties", {}) if name in all]
    return {name: all[name] for name in (*order, *(name for name in all if name not in order))}


def durations_of(row: VerbRow) -> frozenset[str]:
    """Return the names of the arguments that are durations."""
    return frozenset(name for name, schema in _properties(row.arguments).items() if schema.get("format") == "duration")


def given_arguments(row: VerbRow, data: Any) -> Mapping[str, Any]:
    """Return the arguments that are written in the verb's YAML data: those of a map, or the one of the short form."""
    short = short_argument(row)
    return data if isinstance(data, Mapping) else {short: data} if short else {}


def expected_schema(row: VerbRow) -> dict[str, Any]:
    """Return the JSON Schema of some of a verb's arguments, as a story expects them."""
    if row == UNUSABLE:
        return {}
    return written_schema(row._replace(arguments={**row.arguments, "required": []})) | _short_form(row)


def _short_form(row: VerbRow) -> dict[str, Any]:
    short = short_argument(row)
    return {"else": row.arguments["properties"][short]} if short else {}


def default_result(row: VerbRow) -> dict[str, Any]:
    """Return the result of a verb without code that performs it: the defaults in the schema of its result."""
    return _defaults(row.result)


def whole_result(row: VerbRow, returned: Mapping[str, Any]) -> dict[str, Any]:
    """Return the result of a verb, with the defaults of the properties that it lacks."""
    return {**default_result(row), **returned}


def result_schema(row: VerbRow) -> dict[str, Any]:
    """Return the JSON Schema of a whole result, which has every property with a default."""
    required = (*row.result.get("required", ()), *default_result(row))
    return {**row.result, "type": "object", "required": list(dict.fromkeys(required))}


def usual_result(command: BodyCommand | None) -> dict[str, Any] | None:
    """Return the data of `done.command.ID` of a command that ends with its default result; None without one."""
    row = added_row(command) if isinstance(command, Do) else None
    result = default_result(row) if row else None
    return {RESULT: result} if result else None


def texts_in(value: Any, path: NodePath = ()) -> Iterator[tuple[NodePath, str]]:
    """Yield each text in JSON data with its path, which begins with `path`."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from texts_in(item, (*path, key))
    elif isinstance(value, list | tuple):
        for i, item in enumerate(value):
            yield from texts_in(item, (*path, i))


def with_texts(value: Any, change: Callable[[str, NodePath], str], path: NodePath = ()) -> Any:
    """Return JSON data with each text changed; `change` gets the text and its path."""
    match value:
        case str():
            return change(value, path)
        case Mapping():
            return {key: with_texts(item, change, (*path, key)) for key, item in value.items()}
        case list() | tuple():
            return [with_texts(item, change, (*path, i)) for i, item in enumerate(value)]
    return value


def is_template(command: Do) -> bool:
    """Return True if texts of the arguments contain `{{ expression }}`."""
    return any("{{" in text for _, text in texts_in(command.arguments))


def _defaults(schema: Mapping[str, Any]) -> dict[str, Any]:
    return {name: inner["default"] for name, inner in _properties(schema).items() if "default" in inner}


def _properties(schema: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Return the schemas of an object's properties; an empty one for a schema that is only true or false."""
    properties = schema.get("properties", {})
    return {name: inner if isinstance(inner, Mapping) else {} for name, inner in properties.items()}
