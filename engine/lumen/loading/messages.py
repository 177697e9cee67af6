"""Message schemas, `schemas/messages/NAME.schema.json`."""

import json
from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import Diagnostic, Path
from lumen.loading.complaints import complaints
from lumen.loading.source import Document, Report, merge_conflict, parse

ENDING = ".schema.json"
SHORT = 200
"""Characters that a hint may have."""


def build_message(file: str, content: bytes) -> tuple[Mapping[str, Any] | None, list[Diagnostic]]:
    """The JSON Schema in `content`, or None, and what is wrong with it; never raises for what the file holds."""
    try:
        data = json.loads(content)
    except (ValueError, RecursionError) as error:
        return None, [_syntax(file, content, error)]
    report = Report(_places(file, content, data))
    if not isinstance(data, dict):
        report("wrong-type", (), "a message schema should be a map of keys and values", hint='as in {"type": "object"}')
    else:
        _check(data, report)
    return (data if isinstance(data, dict) and not report.diagnostics else None), report.diagnostics


def _check(data: Mapping[str, Any], report: Report) -> None:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    for path, target in _references(data):
        if not target.startswith("#"):
            message, hint = f"`{target}` lies outside this file", "write the definition into this file, under `$defs`"
            report("foreign-reference", path, message, hint=hint)
        elif not _resolves(data, target):
            report("foreign-reference", path, f"`{target}` is not in this file", hint="name a definition under `$defs`")
    errors = Draft202012Validator(Draft202012Validator.META_SCHEMA).iter_errors(data)
    try:
        error: Any = best_match(errors)
    except RecursionError:
        report("too-large", (), "the schema is nested too deeply to be read", hint="use fewer levels")
        return
    if error is not None:
        found = next(complaints(error))
        hint = found.hint if len(found.hint) < SHORT else "it has to be JSON Schema, draft 2020-12"
        report("bad-schema", found.path, f"this is no JSON Schema: {found.message}", hint=hint, key=found.key)


def _references(data: Any) -> list[tuple[Path, str]]:
    found: list[tuple[Path, str]] = []
    waiting: list[tuple[Path, Any]] = [((), data)]
    while waiting:
        path, item = waiting.pop()
        if isinstance(item, dict):
            found += [((*path, k), item[k]) for k in ("$ref", "$dynamicRef") if isinstance(item.get(k), str)]
            waiting += [((*path, key), value) for key, value in item.items()]
        elif isinstance(item, list):
            waiting += [((*path, i), value) for i, value in enumerate(item)]
    return found


def _resolves(data: Any, target: str) -> bool:
    """Whether a JSON pointer leads somewhere; an anchor is taken on trust."""
    if not target.startswith("#/"):
        return True
    for step in target[2:].split("/"):
        key = step.replace("~1", "/").replace("~0", "~")
        if isinstance(data, dict) and key in data:
            data = data[key]
        elif isinstance(data, list) and key.isdecimal() and int(key) < len(data):
            data = data[int(key)]
        else:
            return False
    return True


def _places(file: str, content: bytes, data: Any) -> Document:
    """The document with its places, where YAML's parser can read it too: JSON may be indented with tabs."""
    document, _ = parse(file, content.replace(b"\t", b" "))
    return document or Document(file, data)


def _syntax(file: str, content: bytes, error: Exception) -> Diagnostic:
    from lumen.language.diagnostics import Place

    if conflict := merge_conflict(file, content.decode("utf-8", "replace")):
        return conflict
    hint = "look for a missing comma, quote or bracket here or in the line above"
    if isinstance(error, json.JSONDecodeError):
        place = Place(file, error.lineno, error.colno, error.lineno, error.colno + 1)
        empty = not content.strip()
        code, message = (
            ("empty-file", "the file is empty") if empty else ("json-syntax", f"this is not JSON: {error.msg}")
        )
        return Diagnostic(code, message, place, "write its content, or delete it" if empty else hint)
    if isinstance(error, UnicodeDecodeError):
        return Diagnostic("not-utf8", "the file is not UTF-8 text", Place(file), "save it as UTF-8")
    return Diagnostic(
        "too-large", "the file can't be read: it nests too deeply or holds too long a number", Place(file)
    )
