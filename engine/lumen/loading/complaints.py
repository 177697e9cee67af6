"""Errors of a JSON Schema validator in a student's words."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.language.diagnostics import Path, did_you_mean
from lumen.loading.source import resolve
from lumen.loading.units import seconds

Error = Any
"""A `jsonschema.ValidationError`; its stubs allow for an unset state that a validator never yields."""

TYPES: Mapping[str, str] = {
    "object": "a map of keys and values",
    "array": "a list",
    "string": "a text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "empty",
}
_TRUTHS = {"yes": "true", "y": "true", "on": "true", "no": "false", "n": "false", "off": "false"}
_MEANT = "did you mean `"


@dataclass(frozen=True, slots=True)
class Complaint:
    """One finding: it concerns the node `about`, is shown at `path` (or its key), and costs the node `doomed`.

    `missing` is the key that is not there, `suggestion` the one that an unknown key was probably meant to be.
    """

    code: str
    path: Path
    message: str
    hint: str
    about: Path
    doomed: Path | None
    key: bool = False
    missing: str = ""
    suggestion: str = ""


def complaints(error: Error) -> Iterator[Complaint]:
    """What one error of the validator says, as at most a few findings; alternatives are reduced to the likeliest."""
    keyword, path = error.validator, tuple(error.absolute_path)
    if keyword in ("anyOf", "oneOf") and error.context:
        for inner in _likeliest(error.context):
            yield from complaints(inner)
    elif "propertyNames" in error.relative_schema_path and isinstance(error.instance, str):
        yield _bad_key(error, path)
    elif keyword in ("additionalProperties", "unevaluatedProperties"):
        yield from _unknown_keys(error, path)
    elif keyword == "required":
        yield _missing(error, path)
    elif keyword == "dependentRequired":
        yield from _dependents(error, path)
    elif error.schema == {"minProperties": 1, "maxProperties": 1} or keyword == "maxProperties":
        yield _verbs(error, path)
    else:
        yield _wrong(error, path)


def node(path: Path) -> str:
    """What to call the node at that path."""
    if not path:
        return "this"
    if isinstance(path[-1], str):
        return f"`{path[-1]}`"
    owner = next((f" of `{step}`" for step in reversed(path) if isinstance(step, str)), "")
    return f"item {path[-1] + 1}{owner}"


def kind(value: Any) -> str:
    """What sort of value that is."""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    match value:
        case None:
            return "empty"
        case dict():
            return TYPES["object"]
        case list():
            return TYPES["array"]
        case str():
            return TYPES["string"]
    return f"the number {value:g}" if isinstance(value, float) else "a number"


def _spared(path: Path) -> Path | None:
    """The node to take out, but never the root."""
    return path or None


def _missing(error: Error, path: Path) -> Complaint:
    missing = next(key for key in error.validator_value if key not in error.instance and f"'{key}'" in error.message)
    hint = _describe(_property(error.schema, missing)) or f"write `{missing}:` here"
    message = f"{node(path)} needs the key `{missing}`"
    return Complaint("missing-key", (*path, missing), message, hint, path, _spared(path), missing=missing)


def _dependents(error: Error, path: Path) -> Iterator[Complaint]:
    for key, needs in error.validator_value.items():
        for missing in needs:
            if key in error.instance and missing not in error.instance:
                message = f"`{key}` needs `{missing}` beside it"
                hint = f"write `{missing}:` in the same place"
                yield Complaint("missing-key", (*path, key), message, hint, path, (*path, key), True, missing)


def _unknown_keys(error: Error, path: Path) -> Iterator[Complaint]:
    known = list(error.schema.get("properties", ()))
    patterns = error.schema.get("patternProperties", ())
    for key in error.instance:
        if key in known or any(re.search(pattern, key) for pattern in patterns):
            continue
        hint = did_you_mean(key, [k for k in known if k not in error.instance] or known, "allowed here:")
        if key == "<<":
            hint = "YAML 1.2 has no merge keys: write the keys themselves"
        meant = hint[len(_MEANT) : -2] if hint.startswith(_MEANT) else ""
        message = f"`{key}` is not a key of {node(path)}" if path else f"`{key}` is not a key that can stand here"
        here = (*path, key)
        yield Complaint("unknown-key", here, message, hint, path, here, True, suggestion=meant)


def _bad_key(error: Error, path: Path) -> Complaint:
    here = (*path, error.instance)
    if error.validator == "enum":
        hint = did_you_mean(error.instance, map(str, error.validator_value), "allowed here:")
        return Complaint("unknown-key", here, f"`{error.instance}` can't stand in {node(path)}", hint, path, here, True)
    hint = _describe(error.schema) or "use letters, digits and `_`"
    return Complaint("wrong-key", here, f"`{error.instance}` can't be a key of {node(path)}", hint, path, here, True)


def _verbs(error: Error, path: Path) -> Complaint:
    """An action, or a step of a story, that does nothing or two things."""
    keys = list(error.instance)
    if len(keys) > 1:
        message = f"`{keys[0]}` and `{keys[1]}` stand in one item, which says one thing only"
        hint = f"begin a new item: `- {keys[1]}: …`"
        return Complaint("one-verb", (*path, keys[1]), message, hint, path, _spared(path), True)
    message = f"{node(path)} says nothing: it needs one key, the verb"
    return Complaint("one-verb", path, message, "write the verb, as in `say: Hello`", path, _spared(path))


def _wrong(error: Error, path: Path) -> Complaint:
    code = "wrong-type" if error.validator == "type" else "wrong-value"
    message, hint = _words(error, path)
    return Complaint(code, path, message, hint, path, path if code == "wrong-type" else _spared(path))


def _words(error: Error, path: Path) -> tuple[str, str]:
    """Message and hint of a value that is of the wrong type, or not one of those allowed."""
    value, bound, name = error.instance, error.validator_value, node(path)
    hint = _describe(error.schema)
    match error.validator:
        case "type":
            wanted = [bound] if isinstance(bound, str) else bound
            if value is None:
                return f"{name} is empty, it should be {_either(wanted)}", hint
            return f"{name} should be {_either(wanted)}, not {kind(value)}", _instead(
                value, wanted, error.schema
            ) or hint
        case "enum" | "const":
            allowed = [str(v) for v in (bound if error.validator == "enum" else [bound])]
            return f"{name} can't be `{_short(value)}`", did_you_mean(_short(value), allowed, "it is one of")
        case "pattern":
            return f"{name} can't be `{_short(value)}`", hint
        case "minimum":
            return f"{name} is {value:g}, it should be at least {bound:g}", hint
        case "maximum":
            return f"{name} is {value:g}, it should be at most {bound:g}", hint
        case "exclusiveMinimum":
            return f"{name} is {value:g}, it should be more than {bound:g}", hint
        case "exclusiveMaximum":
            return f"{name} is {value:g}, it should be less than {bound:g}", hint
        case "multipleOf":
            return f"{name} is {value:g}, it should be a multiple of {bound:g}", hint
        case "minLength" | "minProperties" if not value:
            return f"{name} is empty", hint or "write something, or delete it"
        case "minItems":
            return f"{name} has {_count(len(value))}, it should have at least {bound}", hint
        case "items" | "maxItems":
            return f"{name} has too many items", hint
        case "uniqueItems":
            return f"{name} has an item twice", "delete one"
    return f"{name} is not as it should be", hint


def _instead(value: Any, wanted: Iterable[str], schema: Mapping[str, Any]) -> str:
    """What to write in place of a value of the wrong type that is nearly right."""
    if "boolean" in wanted and isinstance(value, str) and (truth := _TRUTHS.get(value.lower())):
        return f"write `{truth}`: in YAML 1.2 `{value}` is a text"
    if {"number", "integer"} & set(wanted) and isinstance(value, str) and type(resolve(value)) in (int, float):
        return f"leave out the quotes: {value}"
    if "string" in wanted and isinstance(value, bool | int | float):
        if any(seconds(example) is not None for example in schema.get("examples", ())):
            return "write the unit too, as in `500ms`, `20s` or `2min`"
        written = str(value).lower() if isinstance(value, bool) else f"{value}"
        return f'put it in quotes: "{written}"'
    return ""


def _either(types: list[str]) -> str:
    words = [TYPES[t] for t in types if t != "null"] or [TYPES["null"]]
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + f" or {words[-1]}"


def _count(number: int) -> str:
    return "1 item" if number == 1 else f"{number} items"


def _short(value: Any) -> str:
    text = "null" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
    return text if len(text) <= 40 else text[:39] + "…"


def _property(schema: Any, key: str) -> Any:
    return schema.get("properties", {}).get(key, {}) if isinstance(schema, dict) else {}


def _describe(schema: Any) -> str:
    """What a schema says of its values, with an example where it is short."""
    if not isinstance(schema, dict):
        return ""
    text = str(schema.get("description", "")).strip().rstrip(".")
    examples = [e for e in schema.get("examples", ()) if not isinstance(e, dict | list)]
    shown = ", ".join(f"`{e}`" for e in examples[:3])
    return f"{text}, as in {shown}" if text and shown else text or (f"as in {shown}" if shown else "")


def _likeliest(context: Iterable[Error]) -> list[Error]:
    """The errors of the alternative that was probably meant: the one whose type fits and that goes wrong latest."""
    branches: dict[Any, list[Error]] = {}
    for error in context:
        branches.setdefault(error.relative_schema_path[0], []).append(error)

    def fit(errors: list[Error]) -> tuple[bool, int, int]:
        shallow = min(len(e.relative_path) for e in errors)
        return not any(e.validator == "type" and not e.relative_path for e in errors), shallow, -len(errors)

    return max(branches.values(), key=fit)
