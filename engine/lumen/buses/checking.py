"""What is wrong with a body, in a line, by the JSON Schema of its message."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lumen.language.projects import Project
from lumen.loading.quick import Quick, quick

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import ValidationError

SHOWN = 80

BodyCheck = Callable[[Any], str]
"""What is wrong with a body; empty where nothing is."""


def checks(project: Project) -> dict[str, BodyCheck]:
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
        error.message if len(error.message) <= 2 * SHOWN else f"{error.message[:SHOWN]} … {error.message[-SHOWN:]}"
    )
    place = error.json_path.removeprefix("$").removeprefix(".")
    return f"{place}: {message}" if place else message
