"""Word the errors of a JSON Schema validator so that a student understands them."""

import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from lumen.expressions.json_schema import occurs
from lumen.language.counts import counted
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.durations import duration_hint, meant_duration
from lumen.language.lookalikes import other_sign, typed
from lumen.language.numbers import is_number
from lumen.project.bracketed_texts import slot_signs
from lumen.project.units import seconds
from lumen.project.yaml_scalars import resolve

Error = Any
"""A `jsonschema.ValidationError`; its stubs allow for an unset state that a validator never yields."""

TYPE_NAMES: Mapping[str, str] = {
    "object": "a map of keys and values",
    "array": "a list",
    "string": "a text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "empty",
}
_NUMBER = re.compile(r"([-+]?\d[\d_]*(?:[.,]\d+)?) ?(°|deg|rad|mm|cm|m|%|px|s|)")
_TRUTHS = {"yes": "true", "y": "true", "on": "true", "no": "false", "n": "false", "off": "false"}


def node(path: NodePath) -> str:
    """Return the name of the node at that path for a message: `say` in backquotes, `item 2 of` its list, or `this`."""
    if not path:
        return "this"
    if isinstance(path[-1], str):
        return f"`{path[-1]}`"
    owner = next((f" of `{step}`" for step in reversed(path) if isinstance(step, str)), "")
    return f"item {path[-1] + 1}{owner}"


def kind(value: Any) -> str:
    """Return the type of a value in words."""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    match value:
        case None:
            return "empty"
        case dict():
            return TYPE_NAMES["object"]
        case list():
            return TYPE_NAMES["array"]
        case str():
            return TYPE_NAMES["string"]
    return f"the number {value:g}" if isinstance(value, float) else "a number"


def wording(error: Error, path: NodePath) -> tuple[str, str]:
    """Return the message and the hint about a value of the wrong type, or one that is not allowed."""
    value, bound, name = error.instance, error.validator_value, node(path)
    hint = describe(error.schema)
    match error.validator:
        case "type":
            wanted = [bound] if isinstance(bound, str) else bound
            right = _transition(value, wanted, path) or _instead(value, wanted, error.schema)
            hint = right or like(path, error.schema, wanted) or hint
            if value is None:
                return f"{name} is empty, but should be {_either(wanted)}", hint
            return f"{name} should be {_either(wanted)}, not {kind(value)}", hint
        case "enum" | "const":
            choices = bound if error.validator == "enum" else [bound]
            allowed = [_short(v) for v in choices if v is not None]
            if True in choices and (truth := _truth(value)) in allowed:
                return f"{name} can't be `{value}`", f"write `{truth}`: in YAML 1.2 `{value}` is a text"
            hint = _colour(value, allowed) or did_you_mean(_short(value), allowed, "allowed:")
            return f"{name} can't be `{_short(value)}`", hint
        case "pattern":
            small = f"write it in lower case: `{value.lower()}`" if occurs(bound, value.lower()) else hint
            if occurs(bound, plain := typed(value)) and plain != value:
                return f"{name} can't be `{_short(value)}`", f"write `{plain}`: {other_sign(value)}"
            return f"{name} can't be `{_short(value)}`", small
        case "minimum" | "maximum" if {"minimum", "maximum"} <= error.schema.keys():
            low, high = error.schema["minimum"], error.schema["maximum"]
            way = "least" if error.validator == "minimum" else "most"
            return f"{name} is {value:g}, but should be at {way} {bound:g}", f"write a number from {low:g} to {high:g}"
        case "minimum":
            return f"{name} is {value:g}, but should be at least {bound:g}", hint
        case "maximum":
            return f"{name} is {value:g}, but should be at most {bound:g}", hint
        case "exclusiveMinimum":
            return f"{name} is {value:g}, but should be more than {bound:g}", hint
        case "exclusiveMaximum":
            return f"{name} is {value:g}, but should be less than {bound:g}", hint
        case "multipleOf":
            return f"{name} is {value:g}, but should be a multiple of {bound:g}", hint
        case "minLength" | "minProperties" if not value:
            return f"{name} is empty", hint or "write a value, or delete the key"
        case "minItems":
            return f"{name} has {counted(len(value), 'item')}, but should have at least {bound}", hint
        case "maxProperties":
            return f"{name} has {counted(len(value), 'key')}, but should have at most {bound}", hint
        case "items" | "maxItems":
            return f"{name} has too many items", hint
        case "uniqueItems":
            return f"{name} has the same item twice", "delete one of them"
    return f"{name} is not valid here", hint


def describe(schema: Any) -> str:
    """Return the description of a schema, with a short example if the schema has one."""
    if not isinstance(schema, dict):
        return ""
    text = str(schema.get("description", "")).strip().rstrip(".")
    given = schema.get("examples", ())
    examples = [e for e in given if not isinstance(e, dict | list)] or [_flow(e) for e in given if len(_flow(e)) <= 40]
    shown = ", ".join(f"`{e}`" for e in examples[:3])
    return f"{text}, as in {shown}" if text and shown else text or (f"as in {shown}" if shown else "")


def like(path: NodePath, schema: Any, wanted: Iterable[str] = ()) -> str:
    """Return the key at the end of a path with a short example from its schema: "write it as in `at: 2s`".

    The example has one of the wanted types; the text is empty if there is no such example.
    """
    if not isinstance(schema, dict) or not path or not isinstance(path[-1], str):
        return ""
    types = {*wanted} or {*_JSON_TYPES.values()}
    fitting = (e for e in schema.get("examples", ()) if _JSON_TYPES.get(type(e)) in types and len(_flow(e)) <= 40)
    example = next(fitting, None)
    return f"write it as in `{path[-1]}: {_flow(example)}`" if example is not None else ""


_JSON_TYPES = {dict: "object", list: "array", str: "string", int: "number", float: "number", bool: "boolean"}


def _transition(value: Any, wanted: Collection[str], path: NodePath) -> str:
    """Return a hint for a transition that lacks its state, or its time or event; empty for any other value."""
    key, holder = path[-1] if path else "", path[-2] if len(path) > 1 else ""
    if value is None and (key in _MOMENTS or holder in _WAITED):
        moment = _MOMENTS[key] if key in _MOMENTS else _moment(holder, str(key))
        return f"write `{_yaml(str(key))}: STATE`, where STATE is the state to enter {moment}"
    if key not in _WAITED or "object" not in wanted:
        return ""
    if isinstance(value, list) and len(value) == 2 and all(isinstance(v, str) for v in value):
        return f"write `{key}: {{{_yaml(value[0])}: {value[1]}}}`"
    if not isinstance(value, str | int | float) or isinstance(value, bool):
        return ""
    text = str(value)
    if key == "after" and not (text := meant_duration(value)):
        return f"write `after: {{TIME: {_short(value)}}}`, where TIME is how long to wait, such as `30s`"
    if key == "at" and not re.match(r"\d{1,2}:\d\d|.* \d{1,2}:\d\d", text):
        return f"write `at: {{TIME: {_short(value)}}}`, where TIME is a time of day, such as `18:00`"
    return f"write `{key}: {{{_yaml(text)}: STATE}}`, where STATE is the state to enter {_moment(key, text)}"


_MOMENTS: Mapping[str | int, str] = {
    "onDone": "when this one is done",
    "onError": "after an error",
    "always": "at once",
}
_WAITED = ("after", "at", "on")


def _moment(key: str | int, text: str) -> str:
    """Return when a row of `after`, `at` or `on` enters its state, as in "after 30 s"."""
    if key == "after":
        return f"after {re.sub(r'(?<=[0-9])(?=[a-z])', ' ', text)}"
    return f"at {text}" if key == "at" else f"on the event `{text}`"


def _yaml(key: str) -> str:
    """Return a key as it is written in YAML: a time of day is in quotes."""
    return f'"{key}"' if ":" in key or " " in key else key


def _flow(value: Any) -> str:
    """Return a value on one line of YAML, in flow style."""
    match value:
        case dict():
            return "{" + ", ".join(f"{k}: {_flow(v)}" for k, v in value.items()) + "}"
        case list():
            return "[" + ", ".join(map(_flow, value)) + "]"
    return "null" if value is None else str(value).lower() if isinstance(value, bool) else str(value)


def _instead(value: Any, wanted: Iterable[str], schema: Mapping[str, Any]) -> str:
    """Return a hint for a value of the wrong type that is nearly right, such as a number in quotes; empty otherwise."""
    if "boolean" in wanted and (truth := _truth(value)):
        return f"write `{truth}`: in YAML 1.2 `{value}` is a text"
    if {"number", "integer"} & set(wanted) and isinstance(value, str):
        if is_number(resolve(value)):
            return f"leave out the quotes: {value}"
        if value != typed(value) and is_number(resolve(typed(value).replace(",", "."))):
            return f"write `{typed(value).replace(',', '.')}`: {other_sign(value)}"
        if number := _NUMBER.fullmatch(value):
            return f"write {number[1].replace(',', '.').replace('_', '')}" + _unit(number[2])
    if "object" in wanted and isinstance(value, str):
        verb, _, rest = value.partition(" ")
        if verb in schema.get("properties", {}):
            return f"`{verb}` needs a colon after it: write `{verb}: {_short(rest)}`"
        if any("to" in example for example in schema.get("examples", ()) if isinstance(example, dict)):
            return f"write `{{to: {_short(value)}}}`"
    listed = isinstance(value, str) and re.fullmatch(r"[\w./-]+( *, *[\w./-]+)*", value)
    if wanted == ["array"] and (listed or is_number(value)):
        parts = re.split(r" *(?:,|(?<=\d)-) *", value) if isinstance(value, str) else [str(value)]
        return f"write it in brackets: `[{', '.join(parts)}]`"
    if "string" in wanted and isinstance(value, bool | int | float):
        examples = schema.get("examples", ())
        if schema.get("format") == "duration" or any(seconds(example) is not None for example in examples):
            return duration_hint(value)
        if any(str(example).endswith("/s") for example in examples) and not isinstance(value, bool):
            return f"write the unit too: `{value:g}/s` or `{value:g}/min`"
        written = str(value).lower() if isinstance(value, bool) else f"{value}"
        return f'put it in quotes: "{written}"'
    if wanted == ["string"] and isinstance(value, list) and value and isinstance(value[0], str):
        return f"only one value is allowed here: write `{_short(value[0])}`"
    if "string" in wanted and isinstance(value, dict) and value and all(v is None for v in value.values()):
        return f'a text that begins with `{{` needs quotes: "{{{_short(", ".join(value))}}}"'
    if "string" in wanted and isinstance(value, dict) and [type(v) for v in value.values()] == [str]:
        text = _short(_flow(value)[1:-1])
        if slot_signs(text) != text:
            return f"a slot needs its type first and no spaces: write `{slot_signs(text)}`"
        return f'a text that contains a colon and a space needs quotes: "{text}"'
    return ""


def _truth(value: Any) -> str:
    """Return `true` or `false` for a word with that meaning; empty for any other value."""
    return _TRUTHS.get(value.lower(), "") if isinstance(value, str) else ""


_COLOURS = {
    "rot": "red", "grün": "green", "gruen": "green", "blau": "blue", "gelb": "yellow", "weiß": "white",
    "schwarz": "black", "lila": "purple", "rosa": "pink", "türkis": "turquoise", "merah": "red", "hijau": "green",
    "biru": "blue", "kuning": "yellow", "putih": "white", "hitam": "black", "ungu": "purple", "aus": "off",
}  # fmt: skip
"""Colours in the languages of the authors of the first exhibitions; CSS has English names."""


def _colour(value: Any, allowed: Collection[str]) -> str:
    """Return a hint for a colour that has no name in CSS; empty if the value is not meant as a colour."""
    if "turquoise" not in allowed or not isinstance(value, str):
        return ""
    if re.fullmatch(r"[0-9a-fA-F]{6}", value):
        return f'write `"#{value}"`: a colour code begins with `#` and needs quotes'
    return f"did you mean `{meant}`?" if (meant := _COLOURS.get(value.lower())) else ""


def _unit(unit: str) -> str:
    """Return the rest of a hint: where to declare the unit that was written after a number; empty for other units."""
    kind = "angle" if unit in ("°", "deg", "rad") else "length" if unit in ("m", "cm", "mm") else ""
    name = "deg" if unit == "°" else unit
    return f", and at the top of the file `units: {{{kind}: {name}}}`" if kind else ""


def _either(types: list[str]) -> str:
    words = [TYPE_NAMES[t] for t in types if t != "null"] or [TYPE_NAMES["null"]]
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + f" or {words[-1]}"


def _short(value: Any) -> str:
    text = "null" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
    return text if len(text) <= 40 else text[:39] + "…"
