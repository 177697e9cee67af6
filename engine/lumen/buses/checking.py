"""What is wrong with a body, in a line, by the JSON Schema of its message."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lumen.language.projects import Project
from lumen.loading.quick import Quick, quick

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import ValidationError

MAX_SHOWN_CHARACTERS = 80
"""How much of either end of a long reason is shown."""

BodyCheck = Callable[[Any], str]
"""What is wrong with a body; empty where nothing is."""


def body_checks(project: Project) -> dict[str, BodyCheck]:
    """A check for every key of the project's routes that names a schema; schemas are compiled when first needed."""
    compiled = {name: SchemaCheck(schema) for name, schema in project.messages.items()}
    return {
        route.key_for(project.robot): compiled[route.schema]
        for route in project.routes.values()
        if route.schema in compiled
    }


class SchemaCheck:
    """A check against one schema (2020-12)."""

    def __init__(self, schema: Mapping[str, object]) -> None:
        self._schema = schema

    def __call__(self, body: Any) -> str:
        if self._quick(body):
            return ""
        error = next(self._validator.iter_errors(body), None)
        return _say(error) if error else ""

    @cached_property
    def _quick(self) -> Quick:
        return quick(self._schema)

    @cached_property
    def _validator(self) -> "Draft202012Validator":
        from jsonschema import Draft202012Validator

        return Draft202012Validator(self._schema)


def _say(error: "ValidationError") -> str:
    """`x: 'left' is not of type 'integer'`, cut where a body holds a picture."""
    message = (
        error.message
        if len(error.message) <= 2 * MAX_SHOWN_CHARACTERS
        else f"{error.message[:MAX_SHOWN_CHARACTERS]} … {error.message[-MAX_SHOWN_CHARACTERS:]}"
    )
    place = error.json_path.removeprefix("$").removeprefix(".")
    return f"{place}: {message}" if place else message
