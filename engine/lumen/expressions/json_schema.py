"""JSON Schema (2020-12): whether data fits, at once; and why not, in jsonschema's words.

jsonschema explains; it takes 20 µs for a body of two numbers and a third of lint's time. Nearly all data fits, and
jsonschema-rs sees that a hundred times as fast (docs/decisions/022). Where it says no, jsonschema is asked. In both a
pattern is one of Lumen's: its letters are those of every script, and none tries one alternative after another.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, TypeGuard

from lumen.errors import ExpressionError
from lumen.expressions.patterns import compile_pattern, for_every_script

if TYPE_CHECKING:
    import jsonschema_rs
    from jsonschema import ValidationError

_DATA = frozenset(("const", "enum", "default", "examples"))
"""Keywords whose values are no schemas."""

_NAMED = frozenset(("properties", "patternProperties", "dependentSchemas", "$defs"))
"""Keywords whose values are schemas under names."""


MAX_DATA_DEPTH = 200
"""Levels of lists and objects that are looked at: jsonschema-rs calls itself for each, until the process ends."""

_FLAT = frozenset((str, int, float, bool, type(None)))


def deeper_than(levels: int, data: Any) -> bool:
    """Whether lists and objects lie within one another in more than so many levels."""
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list | tuple) else ()
    if _FLAT.issuperset(map(type, inner)):
        return not levels and isinstance(data, dict | list | tuple)
    return not levels or any(deeper_than(levels - 1, value) for value in inner if type(value) not in _FLAT)


class JsonSchema:
    """A schema, compiled when it is first needed. Where it is unsound itself, nothing fits, and nothing is wrong."""

    def __init__(self, schema: Any) -> None:
        self.schema = schema

    def fits(self, data: Any) -> bool:
        """Whether the data certainly fits. A no without an error is a yes: nobody else knew what the data is."""
        flat = type(data) is dict and _FLAT.issuperset(map(type, data.values()))  # nearly every message
        if not flat and deeper_than(MAX_DATA_DEPTH, data):
            return False
        try:
            return self._is_valid(data)
        except ValueError:  # half a surrogate pair, a key that is no text
            return False

    def errors(self, data: Any) -> "Iterator[ValidationError]":
        """What is wrong with the data; raises RecursionError where schema or data lead on and on."""
        if deeper_than(MAX_DATA_DEPTH, data):
            raise RecursionError(f"nested more than {MAX_DATA_DEPTH} levels deep")
        if self._only_quick:
            return self._told(data)
        return iter(self._explaining.iter_errors(data)) if self._quick else self._guessed(data)

    @property
    def is_sound(self) -> bool:
        """Whether this is a JSON Schema whose patterns and references can be used."""
        return self._quick is not None

    @cached_property
    def _quick(self) -> "jsonschema_rs.Validator | None":
        """jsonschema-rs's validator; None for what it takes for unsound."""
        from jsonschema_rs import Draft202012Validator, RegexOptions

        if deeper_than(MAX_DATA_DEPTH, self.schema):
            return None
        try:
            return Draft202012Validator(_prepared(self.schema), pattern_options=RegexOptions(), offline=True)
        except ValueError:
            return None

    @cached_property
    def _is_valid(self) -> Callable[[Any], bool]:
        return self._quick.is_valid if self._quick else lambda _: False

    @cached_property
    def _explaining(self) -> Any:
        return _validator_class()(self.schema)

    @cached_property
    def _only_quick(self) -> bool:
        """Whether jsonschema would have to look for key patterns by itself, and with `re`."""
        return {"unevaluatedProperties", "patternProperties"} <= set(keywords(self.schema))

    def _told(self, data: Any) -> "Iterator[ValidationError]":
        """What is wrong, in jsonschema-rs's words."""
        from jsonschema import ValidationError

        for found in self._quick.iter_errors(data) if self._quick else ():
            place, instance = found.instance_path, found.instance
            yield ValidationError(found.message, "schema", place, instance=instance, schema=self.schema)

    def _guessed(self, data: Any) -> "Iterator[ValidationError]":
        """What is wrong by a schema that jsonschema-rs takes for unsound; nothing where jsonschema agrees."""
        from jsonschema import SchemaError
        from referencing.exceptions import Unresolvable

        with suppress(SchemaError, Unresolvable):
            _validator_class().check_schema(self.schema)
            yield from self._explaining.iter_errors(data)


def occurs(pattern: str, text: str) -> bool:
    """Whether the pattern occurs in the text; also where it can't be read, which lint tells."""
    try:
        return compile_pattern(pattern).search(text)
    except ExpressionError:
        return True


def _prepared(schema: Any) -> Any:
    """The schema with each pattern as the engine has to be given it."""
    if isinstance(schema, list):
        return [_prepared(inner) for inner in schema]
    if not isinstance(schema, dict):
        return schema
    prepared = {
        keyword: _prepared(inner) if isinstance(inner, dict | list) and keyword not in _DATA else inner
        for keyword, inner in schema.items()
    }
    if isinstance(pattern := schema.get("pattern"), str):
        prepared["pattern"] = for_every_script(pattern)
    if isinstance(patterns := prepared.get("patternProperties"), dict):
        prepared["patternProperties"] = {for_every_script(pattern): inner for pattern, inner in patterns.items()}
    return prepared


def is_usable_alone(schema: object) -> TypeGuard[dict[str, Any]]:
    """Return True for a JSON Schema whose patterns can be used, and that refers to no other by `$ref`."""
    return isinstance(schema, dict) and "$ref" not in keywords(schema) and JsonSchema(schema).is_sound


def keywords(schema: Any) -> Iterator[str]:
    """Iterate over all keywords in a schema."""
    for keyword, inner in schema.items() if isinstance(schema, dict) else ():
        yield keyword
        named = isinstance(inner, dict) and keyword in _NAMED
        for part in inner.values() if named else inner if isinstance(inner, list) else (inner,):
            yield from keywords(part)


@cache
def _validator_class() -> Any:
    """jsonschema's validator, with patterns that do not try one alternative after another."""
    from jsonschema import Draft202012Validator  # takes 0.1 s: only where something is wrong
    from jsonschema.validators import extend

    ours = {
        "pattern": _pattern,
        "patternProperties": _pattern_properties,
        "additionalProperties": _additional_properties,
    }
    return extend(Draft202012Validator, ours)  # type: ignore[no-untyped-call]


def _pattern(validator: Any, pattern: str, text: Any, schema: Any) -> "Iterator[ValidationError]":
    from jsonschema import ValidationError

    if validator.is_type(text, "string") and not occurs(pattern, text):
        yield ValidationError(f"{text!r} does not match {pattern!r}")


def _pattern_properties(
    validator: Any, patterns: Mapping[str, Any], data: Any, schema: Any
) -> "Iterator[ValidationError]":
    for pattern, inner in patterns.items() if validator.is_type(data, "object") else ():
        for key in data:
            if occurs(pattern, key):
                yield from validator.descend(data[key], inner, path=key, schema_path=pattern)


def _additional_properties(validator: Any, wanted: Any, data: Any, schema: Any) -> "Iterator[ValidationError]":
    """jsonschema's own, of the keys that no pattern names."""
    from jsonschema import Draft202012Validator

    patterns = schema.get("patternProperties", ())
    if patterns and validator.is_type(data, "object"):
        data = {key: value for key, value in data.items() if not any(occurs(pattern, key) for pattern in patterns)}
        schema = {keyword: value for keyword, value in schema.items() if keyword != "patternProperties"}
    yield from Draft202012Validator.VALIDATORS["additionalProperties"](validator, wanted, data, schema)
