"""The check of a body by the JSON Schema of its message, with a one-line reason."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lumen.bus.bodies import text_of_json
from lumen.expressions.json_schema import JsonSchema
from lumen.language.projects import Project

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError

MAX_SHOWN_CHARACTERS = 80
"""The number of characters of a long reason that are shown at either end."""


def body_checks(project: Project) -> dict[str, "SchemaCheck"]:
    """Return a check for every key of the project's routes with a schema; schemas are compiled on first use."""
    compiled = {name: SchemaCheck(schema) for name, schema in project.messages.items()}
    return {
        key: compiled[route.schema]
        for route in project.routes.values()
        if route.schema in compiled
        for key in (route.alias, *map(route.key_for, project.served))
        if key
    }


class SchemaCheck:
    """A check by one schema (2020-12): a call returns the fault of a body; empty for a valid body."""

    def __init__(self, schema: Mapping[str, object]) -> None:
        self._schema = JsonSchema(schema)
        self.fits = self._schema.fits
        """Returns only whether a body is valid."""

    def __call__(self, body: Any) -> str:
        if self.fits(body):
            return ""
        if reason := text_of_json(body):
            return reason
        try:
            error = next(self._schema.errors(body), None)
        except RecursionError:
            return "it is nested too deeply"
        return _say(error) if error else ""


def _say(error: "ValidationError") -> str:
    """Return an error as `x: 'left' is not of type 'integer'`, cut if it contains a long body such as a picture."""
    message = (
        error.message
        if len(error.message) <= 2 * MAX_SHOWN_CHARACTERS
        else f"{error.message[:MAX_SHOWN_CHARACTERS]} … {error.message[-MAX_SHOWN_CHARACTERS:]}"
    )
    place = error.json_path.removeprefix("$").removeprefix(".")
    return f"{place}: {message}" if place else message
