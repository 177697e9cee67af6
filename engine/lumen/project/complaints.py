"""Turn the errors of a JSON Schema validator into findings that a student understands."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.expressions.json_schema import occurs
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean, mean, nearest
from lumen.language.lookalikes import other_sign, typed
from lumen.project.schema_messages import Error, describe, like, node, wording

MISSING_KEY = Code("missing-key", "shape", ERROR, "a required key is missing")
ONE_VERB = Code("one-verb", "shape", ERROR, "an item has no verb, or more than one")
UNKNOWN_KEY = Code("unknown-key", "shape", ERROR, "a key is not allowed here")
WRONG_KEY = Code("wrong-key", "shape", ERROR, "a name has a character or form that is not allowed")
WRONG_TYPE = Code("wrong-type", "shape", ERROR, "a value has the wrong type: text, number, list or map")
WRONG_VALUE = Code("wrong-value", "shape", ERROR, "a value is not one of those allowed")


MAX_UNKNOWN_KEYS = 50
"""The number of unknown keys of a node for which a suggestion is sought; the rest are reported without a hint."""


@dataclass(frozen=True, slots=True)
class Complaint:
    """One finding about the data of a document."""

    code: Code
    path: NodePath
    """The node where the finding is shown: at its value, or at its key if `key` is true."""
    message: str
    hint: str
    about: NodePath
    """The node with the fault, which may be another than the one where it is shown."""
    doomed: NodePath | None
    """The node that must be left out because of the fault; None if all can stay."""
    key: bool = False
    """True if the finding is shown at the key of the node instead of its value."""
    missing: str = ""
    """The key that is absent; empty for other findings."""
    suggestion: str = ""
    """The known key that was probably meant by an unknown key; empty if none is similar."""


def complaints(error: Error, root: Any = None) -> Iterator[Complaint]:
    """Yield the few findings that describe one error of the validator; of alternatives, only the likeliest.

    `root` is the whole schema, in which the hint about a misplaced key finds the right place.
    """
    keyword, path = error.validator, tuple(error.absolute_path)
    if meant := _misspelt_entry(error, path, root):
        if keyword == "required":
            here, message = path, f"`{path[-1]}` is not a key of {node(path[:-1])}"
            yield Complaint(UNKNOWN_KEY, here, message, mean(path[-1], meant), path[:-1], here, True, suggestion=meant)
        return
    if keyword in ("anyOf", "oneOf") and error.context:
        for inner in _likeliest(error.context):
            yield from complaints(inner, root)
    elif "propertyNames" in error.relative_schema_path and isinstance(error.instance, str):
        yield _bad_key(error, path)
    elif keyword in ("additionalProperties", "unevaluatedProperties"):
        yield from _unknown_keys(error, path, root)
    elif keyword == "required":
        yield _missing(error, path, error.schema if path else root)
    elif keyword == "dependentRequired":
        yield from _dependents(error, path)
    elif error.schema == {"minProperties": 1, "maxProperties": 1} or (
        keyword == "maxProperties" and error.validator_value == 1
    ):
        yield _verbs(error, path)
    else:
        yield _wrong(error, path)


def _misspelt_entry(error: Error, path: NodePath, root: Any) -> str:
    """Return the known name that was probably meant by an entry's misspelt name; empty if the name is not misspelt.

    In `modules` of lumen.yaml, known names have keys of their own, and an entry of any other name needs a `command`. So
    an entry that lacks that key, and whose name resembles a known one, is misspelt.
    """
    section = root.get("properties", {}).get(path[0]) if isinstance(root, Mapping) and len(path) == 2 else None
    known = section.get("properties", ()) if isinstance(section, Mapping) else ()
    if not known or path[1] in known or not isinstance(error.instance, Mapping):
        return ""
    lacks = any(key not in error.instance for key in error.schema.get("required", ()))
    return nearest(path[1], known) if lacks else ""


def _spared(path: NodePath) -> NodePath | None:
    """Return the path of the node to leave out; None for the root, which is never left out."""
    return path or None


def _missing(error: Error, path: NodePath, schema: Any) -> Complaint:
    """Return the finding about an absent key, described in the words of `schema`."""
    absent = [key for key in error.validator_value if key not in error.instance]
    missing = next((key for key in absent if error.message.startswith(repr(key))), absent[0])
    shown = like((missing,), _property(schema, missing)).replace("write it as in", "add it, as in")
    hint = shown or describe(_property(schema, missing)) or f"add `{missing}:` here"
    message = f"{node(path)} needs the key `{missing}`"
    if holder := next((k for k, v in error.instance.items() if isinstance(v, Mapping) and missing in v), ""):
        message += f", which is inside its `{holder}`"
        hint = f"indent `{missing}` and the lines under it less, so that it begins in the same column as `{holder}`"
        return Complaint(MISSING_KEY, (*path, holder, missing), message, hint, path, _spared(path), True, missing)
    return Complaint(MISSING_KEY, (*path, missing), message, hint, path, _spared(path), missing=missing)


def _dependents(error: Error, path: NodePath) -> Iterator[Complaint]:
    for key, needs in error.validator_value.items():
        for missing in needs:
            if key in error.instance and missing not in error.instance:
                message = f"`{key}` also needs the key `{missing}`"
                hint = f"add `{missing}:` beside it"
                yield Complaint(MISSING_KEY, (*path, key), message, hint, path, (*path, key), True, missing)


def _unknown_keys(error: Error, path: NodePath, root: Any) -> Iterator[Complaint]:
    known = list(error.schema.get("properties", ()))
    patterns = error.schema.get("patternProperties", ())
    free = [k for k in known if k not in error.instance] or known
    unknown = [k for k in error.instance if not (k in known or any(occurs(pattern, k) for pattern in patterns))]
    for key in unknown[MAX_UNKNOWN_KEYS:]:
        here, message = (*path, key), f"`{key}` is not a key of {node(path)}"
        yield Complaint(UNKNOWN_KEY, here, message, "", path, here, True)
    for key in unknown[:MAX_UNKNOWN_KEYS]:
        meant = next((also for also in _ALSO.get(key, "").split() if also in free), "") or nearest(key, free)
        torn = _torn(error.instance, key)
        first, _, rest = key.partition(" ")
        if rest and first in known and key not in known:
            meant = first
        hint = mean(key, meant) if meant else did_you_mean(key, free, "allowed here:")
        if rest and meant == first:
            value = rest if error.instance[key] is None else f"{rest}: …"
            hint = f"`{first}` needs a colon after it: write `{first}: {value}`"
        elif torn:
            meant, hint = "", f'a comma ends a text inside braces: put quotes around the whole text: "{torn}"'
        elif key == "<<":
            hint = "YAML 1.2 has no merge keys: write each key out"
        elif key.isdecimal() and not meant:
            hint = "put a list in brackets; write a decimal number with a point, as in `0.5`"
        elif not meant and (odd := other_sign(key)):
            hint = f"write `{typed(key).strip()}`: {odd}"
        elif not meant and (owner := _owner(key, root)):
            hint = f"move it into {owner}"
        message = f"`{key}` is not a key of {node(path)}" if path else f"`{key}` is not a key of this file"
        here = (*path, key)
        yield Complaint(UNKNOWN_KEY, here, message, hint, path, here, True, suggestion=meant)


def _torn(instance: Mapping[str, Any], key: str) -> str:
    """Return the whole text if the key is the part after a comma, as in `{say: Oh, step back}`; else an empty one."""
    keys = list(instance)
    before = instance[keys[keys.index(key) - 1]] if keys.index(key) else None
    whole = isinstance(before, str) and instance[key] is None and " " in f"{before}{key}"
    return f"{before}, {key}" if whole else ""


_ALSO = {
    "next": "onDone", "goto": "target walk", "to": "target", "transitions": "on", "events": "on", "timeout": "after",
    "onEntry": "entry", "onExit": "exit", "enter": "entry", "cond": "guard", "if": "guard", "when": "guard",
    "unless": "guard", "condition": "guard",
    "speak": "say", "tell": "say", "talk": "say", "text": "say", "sleep": "wait", "pause": "wait", "delay": "wait",
    "move": "play", "motion": "play", "gesture": "play", "animation": "play", "led": "leds", "lights": "leds",
    "after": "wait", "go": "walk", "drive": "walk", "place": "to", "destination": "to",
    "time": "at", "angles": "joints", "pin": "key", "topic": "key", "exchange": "key",
}  # fmt: skip
"""The names that other tools, or other words of Lumen, use for Lumen's keys. The first that is allowed is suggested."""


def _owner(key: str, root: Any) -> str:
    """Return the definition of the schema that has this key, with an article; empty if no definition has the key."""
    definitions = root.get("$defs", {}) if isinstance(root, Mapping) else {}
    owner = next((name for name, schema in definitions.items() if key in schema.get("properties", ())), "")
    return f"an {owner}" if owner[:1] in tuple("aeiou") else f"a {owner}" if owner else ""


_LANGUAGES = {
    "english": "en", "englisch": "en", "inggris": "en", "german": "de", "deutsch": "de", "jerman": "de",
    "indonesian": "id", "indonesisch": "id", "indonesia": "id", "french": "fr", "spanish": "es", "italian": "it",
    "dutch": "nl", "polish": "pl", "turkish": "tr", "chinese": "zh", "japanese": "ja", "korean": "ko",
}  # fmt: skip
"""Language codes of ISO 639 by the names that people write instead."""


def _bad_key(error: Error, path: NodePath) -> Complaint:
    here = (*path, error.instance)
    if error.validator == "enum":
        hint = did_you_mean(error.instance, map(str, error.validator_value), "allowed here:")
        return Complaint(
            UNKNOWN_KEY, here, f"`{error.instance}` is not allowed in {node(path)}", hint, path, here, True
        )
    hint = describe(error.schema) or "use letters, digits and `_`"
    if odd := other_sign(error.instance):
        hint = f"write `{typed(error.instance).strip()}`: {odd}"
    if code := _LANGUAGES.get(error.instance.lower(), ""):
        hint = f"write the language as a code: `{code}`"
    return Complaint(WRONG_KEY, here, f"`{error.instance}` is not a valid key in {node(path)}", hint, path, here, True)


def _verbs(error: Error, path: NodePath) -> Complaint:
    """Return the finding about an action, or a step of a story, with no verb or with two."""
    keys = list(error.instance)
    if len(keys) > 1:
        within, hint = "one item", f"begin a new item: `- {keys[1]}: …`"
        if "minProperties" not in error.schema:  # a key that allows no other next to it
            within, hint = node(path), "keep one of the two"
        message = f"`{keys[0]}` and `{keys[1]}` are both in {within}, but only one of them is allowed"
        return Complaint(ONE_VERB, (*path, keys[1]), message, hint, path, _spared(path), True)
    message = f"{node(path)} is empty: it needs a verb"
    return Complaint(ONE_VERB, path, message, "write the verb, as in `say: Hello`", path, _spared(path))


def _wrong(error: Error, path: NodePath) -> Complaint:
    code = WRONG_TYPE if error.validator == "type" else WRONG_VALUE
    message, hint = wording(error, path)
    return Complaint(code, path, message, hint, path, path if code == WRONG_TYPE else _spared(path))


def _property(schema: Any, key: str) -> Any:
    return schema.get("properties", {}).get(key, {}) if isinstance(schema, dict) else {}


def _likeliest(context: Iterable[Error]) -> list[Error]:
    """Return the errors of the alternative that was probably meant: of the value's type, with the deepest fault."""
    branches: dict[Any, list[Error]] = {}
    for error in context:
        branches.setdefault(error.relative_schema_path[0], []).append(error)

    def fit(errors: list[Error]) -> tuple[bool, int, int]:
        shallow = min(len(e.relative_path) for e in errors)
        return not any(e.validator == "type" and not e.relative_path for e in errors), shallow, -len(errors)

    return max(branches.values(), key=fit)
