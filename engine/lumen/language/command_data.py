"""Commands as JSON data: in the journal, and in the trace that the brain publishes on the bus.

Both forms follow from the classes of `Command` and their fields, so a new command needs no row here. The messages with
commands for a robot, which still have the form of 2015, are in `robot/command_table.py`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from typing import Any, get_args

from lumen.language.commands import BodyCommand, Command, Publish, Start

_TRACED: Mapping[str, type] = {kind.__name__.lower(): kind for kind in get_args(BodyCommand)}
"""The commands of a body by their names in a trace."""


def command_data(value: Any) -> Any:
    """Return a command in the journal's form, `{Start: {id: d1, command: {Say: {text: Hello}}}}`.

    Fields with their default values are left out, so a later Lumen with more fields writes the same data.
    """
    if is_dataclass(value) and not isinstance(value, type):
        said = ((field.name, getattr(value, field.name), _usual(field)) for field in _compared(type(value)))
        return {type(value).__name__: {name: command_data(given) for name, given, usual in said if given != usual}}
    if isinstance(value, Mapping):
        return {str(key): command_data(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [command_data(item) for item in value]
    return value


def _said(command: Any) -> dict[str, Any]:
    kind: Any = type(command)
    return {field.name: getattr(command, field.name) for field in _compared(kind)}


@cache
def _compared(kind: Any) -> tuple[Field[Any], ...]:
    return tuple(field for field in fields(kind) if field.compare)


def _usual(field: Field[Any]) -> Any:
    if field.default_factory is not MISSING:
        return field.default_factory()
    return field.default


def started(command: Any) -> tuple[str, str, Mapping[str, Any]] | None:
    """Return the id, the kind (`Say`) and the fields of a `Start` in the journal's form; None for any other data."""
    match command:
        case {"Start": {"id": str(id), "command": Mapping() as body}} if body:
            kind, said = next(iter(body.items()))
            return id, kind, said
    return None


def traced(command: Command) -> dict[str, Any] | None:
    """Return a `Start` or `Publish` in the trace's form, `{verb: say, id: d1, text: Hello, …}`; None for any other."""
    match command:
        case Start(id, wanted):
            return {"verb": trace_verb(wanted), "id": id, **_said(wanted)}
        case Publish(route, body):
            return {"verb": "publish", "route": route, "body": body}
    return None


def trace_verb(command: BodyCommand) -> str:
    """Return the name of a command in a trace."""
    return type(command).__name__.lower()


def from_trace(said: Mapping[str, Any]) -> Command | None:
    """Return the command that `traced` wrote; None if its verb or its fields are unknown."""
    given = dict(said)
    verb, id = str(given.pop("verb", "")), str(given.pop("id", ""))
    if verb == "publish":
        return Publish(str(given.get("route", "")), given.get("body"))
    kind = _TRACED.get(verb)
    try:
        return Start(id, kind(**given)) if kind else None
    except TypeError:
        return None
