"""Message schemas, `schemas/messages/NAME.schema.json`."""

import json
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.json_schema import deeper_than
from lumen.expressions.patterns import compile_pattern
from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath, Place
from lumen.language.json_paths import values_in
from lumen.project.complaints import WRONG_TYPE, WRONG_VALUE
from lumen.project.document import MAX_NODE_DEPTH, TOO_LARGE, Document
from lumen.project.document_report import DocumentReport
from lumen.project.schema import schema_faults
from lumen.project.yaml_errors import NOT_UTF8, merge_conflict
from lumen.project.yaml_reader import EMPTY_FILE, parse

JSON_SYNTAX = Code("json-syntax", "text", ERROR, "a message schema is not JSON")
ENDLESS_REFERENCE = Code("endless-reference", "routes", ERROR, "a reference in a message schema refers to itself")
FOREIGN_REFERENCE = Code("foreign-reference", "routes", ERROR, "a message schema refers to something outside itself")


SCHEMA_SUFFIX = ".schema.json"

MAX_INDEX_DIGITS = 10
"""The maximum number of digits of a list index in a reference."""

_IN_PLACE = ("allOf", "anyOf", "oneOf", "not", "if", "then", "else", "$ref")
"""Keywords whose schemas apply to the same value as the schema that contains them."""


@lru_cache(maxsize=1_024)
def build_message(file: str, content: bytes) -> tuple[Mapping[str, Any] | None, tuple[Diagnostic, ...]]:
    """Return the JSON Schema in `content` and its faults; None instead of the schema if it has any.

    No content of the file raises an error. Results are cached, so don't change the schema.
    """
    try:
        data = json.loads(content)
    except (ValueError, RecursionError) as error:
        return None, (_syntax(file, content, error),)
    if deeper_than(MAX_NODE_DEPTH, data):
        return None, (
            TOO_LARGE.at(Place(file), f"the file is nested deeper than {MAX_NODE_DEPTH} levels", "simplify it"),
        )
    if _plainly_sound(data, content):
        return data, ()
    document, found = parse(file, content.replace(b"\t", b" "))  # JSON may be indented with tabs
    report = DocumentReport(document or Document(file, data))
    report.diagnostics += found
    data = document.data if document and found else data  # of duplicate keys, JSON keeps the last one
    if isinstance(data, dict):
        examine(data, report)
    else:
        report(WRONG_TYPE, (), "a message schema must be a map of keys and values", hint='as in {"type": "object"}')
    return (None if report.diagnostics else data), tuple(report.diagnostics)


def _plainly_sound(data: Any, content: bytes) -> bool:
    """Return True if a schema certainly has no fault, so that it need not be parsed with places, which is slow."""
    try:
        json.loads(content, object_pairs_hook=_each_once)
        if not isinstance(data, dict):
            return False
    except KeyError:
        return False
    return examine(data, DocumentReport(Document("", data)))


def _each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return the map of these keys and values. Raises KeyError if a key occurs twice."""
    found = dict(pairs)
    if len(found) < len(pairs):
        raise KeyError
    return found


def examine(schema: Any, report: DocumentReport, where: NodePath = ()) -> bool:
    """Return True if the JSON Schema at `where` in the report's document is valid; report its faults."""
    before = len(report.diagnostics)
    for found in schema_faults(schema):
        report(found.code, (*where, *found.path), found.message, hint=found.hint, key=found.key)
    if len(report.diagnostics) == before:
        _refer(schema, report, where)
    return len(report.diagnostics) == before


def _refer(data: Any, report: DocumentReport, where: NodePath) -> None:
    """Report faults that the metaschema can't express: invalid regular expressions and references."""
    for inner, key, text in _texts(data):
        path = (*where, *inner)
        if key == "pattern" or inner[-2:-1] == ("patternProperties",):
            _pattern(path, text, report)
        elif key == "$ref" and not text.startswith("#"):
            hint = "copy the definition into this file, under `$defs`"
            report(FOREIGN_REFERENCE, path, f"`{text}` is outside this file", hint=hint)
        elif key == "$ref" and _target(data, text) is None:
            report(
                FOREIGN_REFERENCE, path, f"`{text}` is not in this schema", hint="refer to a definition under `$defs`"
            )
        elif key == "$ref" and _circles(data, text):
            hint = "move the reference into `properties` or `items`"
            report(ENDLESS_REFERENCE, path, f"`{text}` refers to itself for the same value", hint=hint)


def _texts(data: Any) -> Iterator[tuple[NodePath, str, str]]:
    """Yield every text of a schema with its path and key, and the keys of `patternProperties` as texts."""
    waiting: list[tuple[NodePath, Any]] = [((), data)]
    while waiting:
        path, item = waiting.pop()
        if isinstance(item, dict):
            for key, value in item.items():
                if isinstance(value, str):
                    yield (*path, key), key, value
                elif path[-1:] == ("patternProperties",):
                    yield (*path, key), "", key
            waiting += [
                ((*path, key), v) for key, v in item.items() if key not in ("default", "const", "examples", "enum")
            ]
        elif isinstance(item, list):
            waiting += [((*path, i), value) for i, value in enumerate(item)]


def _pattern(path: NodePath, text: str, report: DocumentReport) -> None:
    try:
        compile_pattern(text)
    except ExpressionError as error:
        report(WRONG_VALUE, path, f"`{text}` is not a regular expression: {error.message}", hint=error.hint)


def _target(data: Any, reference: str) -> Any:
    """Return the schema that a JSON pointer or an anchor of this file refers to; None if it is absent."""
    if reference != "#" and not reference.startswith("#/"):
        named = (each for each in values_in(data) if isinstance(each, dict) and each.get("$anchor") == reference[1:])
        return next(named, None)
    for step in reference[2:].split("/") if len(reference) > 1 else ():
        key = step.replace("~1", "/").replace("~0", "~")
        if isinstance(data, dict) and key in data:
            data = data[key]
        elif isinstance(data, list) and key.isdecimal() and len(key) < MAX_INDEX_DIGITS and int(key) < len(data):
            data = data[int(key)]
        else:
            return None
    return data if isinstance(data, dict | bool) else None


def _circles(data: Any, reference: str) -> bool:
    """Return True if a reference leads back to itself without going deeper into the value."""
    seen: set[str] = set()
    waiting = [_target(data, reference)]
    while waiting:
        item = waiting.pop()
        for key in _IN_PLACE if isinstance(item, dict) else ():
            inner = item.get(key)
            if isinstance(inner, str):
                if inner == reference:
                    return True
                if inner not in seen:
                    seen.add(inner)
                    waiting.append(_target(data, inner))
            else:
                waiting += inner if isinstance(inner, list) else [inner]
    return False


def _syntax(file: str, content: bytes, error: Exception) -> Diagnostic:
    if conflict := merge_conflict(file, content.decode("utf-8", "replace")):
        return conflict
    if not content.strip():
        return EMPTY_FILE.at(Place(file), "the file is empty", "add its content, or delete the file")
    if isinstance(error, json.JSONDecodeError):
        place = Place(file, error.lineno, error.colno, error.lineno, error.colno + 1)
        hint = "look for a missing comma, quote or bracket here or in the line above"
        return JSON_SYNTAX.at(place, f"this is not JSON: {error.msg}", hint)
    if isinstance(error, UnicodeDecodeError):
        return NOT_UTF8.at(Place(file), "the file is not UTF-8 text", "save it as UTF-8")
    return TOO_LARGE.at(Place(file), "the file is nested too deeply, or a number in it is too long", "simplify it")
