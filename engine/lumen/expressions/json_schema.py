"""JSON Schema (2020-12): a fast check whether data fits, and an explanation by jsonschema if it does not.

jsonschema explains errors well, but needs 20 µs for a body of two numbers and a third of lint's time. Nearly all data
fits, and jsonschema-rs confirms this a hundred times as fast (docs/decisions/022); jsonschema runs only if the data
does not fit. Both use Lumen's patterns: letters are those of every script, and matching never backtracks.
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
"""Keywords whose values are data, not schemas."""

_NAMED = frozenset(("properties", "patternProperties", "dependentSchemas", "$defs"))
"""Keywords whose values map names to schemas."""


MAX_DATA_DEPTH = 200
"""The greatest number of levels of lists and objects in checked data.

jsonschema-rs recurses, and data that is nested deeper could end the process.
"""

_FLAT = frozenset((str, int, float, bool, type(None)))


def deeper_than(levels: int, data: Any) -> bool:
    """Return whether lists and objects are nested in more than `levels` levels."""
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list | tuple) else ()
    if _FLAT.issuperset(map(type, inner)):
        return not levels and isinstance(data, dict | list | tuple)
    return not levels or any(deeper_than(levels - 1, value) for value in inner if type(value) not in _FLAT)


class JsonSchema:
    """A schema, compiled on first use. If the schema itself is invalid, `fits` is False and `errors` empty."""

    def __init__(self, schema: Any) -> None:
        self.schema = schema

    def fits(self, data: Any) -> bool:
        """Return True if the data certainly fits; if False, it still fits unless `errors` finds an error."""
        flat = type(data) is dict and _FLAT.issuperset(map(type, data.values()))  # nearly every message
        if not flat and deeper_than(MAX_DATA_DEPTH, data):
            return False
        try:
            return self._is_valid(data)
        except ValueError:  # half a surrogate pair, or a key that is not a string
            return False

    def errors(self, data: Any) -> "Iterator[ValidationError]":
        """Return an iterator over the errors of the data; raise RecursionError if the data is nested too deeply."""
        if deeper_than(MAX_DATA_DEPTH, data):
            raise RecursionError(f"nested more than {MAX_DATA_DEPTH} levels deep")
        if self._only_quick:
            return self._told(data)
        return iter(self._explaining.iter_errors(data)) if self._quick else self._guessed(data)

    @property
    def is_sound(self) -> bool:
        """Whether this is a valid JSON Schema whose patterns and references can be used."""
        return self._quick is not None

    @cached_property
    def _quick(self) -> "jsonschema_rs.Validator | None":
        """The validator of jsonschema-rs; None if the schema is nested too deeply or jsonschema-rs rejects it."""
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
        """Whether only jsonschema-rs is usable: jsonschema would match key patterns with its own code and `re`."""
        return {"unevaluatedProperties", "patternProperties"} <= set(keywords(self.schema))

    def _told(self, data: Any) -> "Iterator[ValidationError]":
        """Yield the errors that jsonschema-rs finds, in its words."""
        from jsonschema import ValidationError

        for found in self._quick.iter_errors(data) if self._quick else ():
            place, instance = found.instance_path, found.instance
            yield ValidationError(found.message, "schema", place, instance=instance, schema=self.schema)

    def _guessed(self, data: Any) -> "Iterator[ValidationError]":
        """Yield the errors by a schema that jsonschema-rs rejects; none if jsonschema rejects the schema too."""
        from jsonschema import SchemaError
        from referencing.exceptions import Unresolvable

        with suppress(SchemaError, Unresolvable):
            _validator_class().check_schema(self.schema)
            yield from self._explaining.iter_errors(data)


def occurs(pattern: str, text: str) -> bool:
    """Return whether the pattern matches anywhere in the text; True if the pattern is invalid, which lint reports."""
    try:
        return compile_pattern(pattern).search(text)
    except ExpressionError:
        return True


def _prepared(schema: Any) -> Any:
    """Return the schema with each pattern in the form that the regex engine needs."""
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
    """Return whether this is a valid JSON Schema with usable patterns and without `$ref`."""
    return isinstance(schema, dict) and "$ref" not in keywords(schema) and JsonSchema(schema).is_sound


def keywords(schema: Any) -> Iterator[str]:
    """Yield all keywords in a schema, including those of nested schemas."""
    for keyword, inner in schema.items() if isinstance(schema, dict) else ():
        yield keyword
        named = isinstance(inner, dict) and keyword in _NAMED
        for part in inner.values() if named else inner if isinstance(inner, list) else (inner,):
            yield from keywords(part)


@cache
def _validator_class() -> Any:
    """Return the validator class of jsonschema, with patterns that never backtrack."""
    from jsonschema import Draft202012Validator  # takes 0.1 s: import it only to explain errors
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
    """Yield the errors that jsonschema finds in the keys that match no pattern."""
    from jsonschema import Draft202012Validator

    patterns = schema.get("patternProperties", ())
    if patterns and validator.is_type(data, "object"):
        data = {key: value for key, value in data.items() if not any(occurs(pattern, key) for pattern in patterns)}
        schema = {keyword: value for keyword, value in schema.items() if keyword != "patternProperties"}
    yield from Draft202012Validator.VALIDATORS["additionalProperties"](validator, wanted, data, schema)
