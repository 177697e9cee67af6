"""Convert actions, values and transitions of a machine to YAML data; lengths are in [m], angles in [rad]."""

from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any, assert_never

from lumen.expressions import unparse
from lumen.expressions.readings import as_written
from lumen.expressions.tree import Literal
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    ComputedValue,
    Expression,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Template,
    Wait,
)
from lumen.language.buttons import Button
from lumen.language.machines import MachineDefinition
from lumen.language.verbs import Quantity, verb_of
from lumen.project.formats.durations import duration

ActionData = dict[str, Any]
"""An action of a behaviour file: its verb, and the verb's arguments."""

TransitionData = dict[str, Any]
"""A transition of a behaviour file: `target`, `guard`, `actions`, `reenter`."""


def plain_block(steps: Iterable[PlacedAction]) -> list[ActionData]:
    """Return a list of actions as data."""
    return [plain_action(step.action) for step in steps]


def plain_button(button: Button) -> dict[str, Any]:
    """Return an entry of `buttons`."""
    label = button.label.get("", dict(button.label))
    row: dict[str, Any] = {"label": label, "event": button.event}
    more = {"data": button.data, "confirm": button.confirm or None, "key": button.key or None}
    return row | {key: value for key, value in more.items() if value is not None}


def plain_value(value: ComputedValue) -> Any:
    """Return a value as data; expressions become texts."""
    match value:
        case Expression(source):
            return as_written(source)
        case tuple():
            return [plain_value(item) for item in value]
        case Mapping():
            return {key: plain_value(item) for key, item in value.items()}
    return value


def plain_phrases(table: Mapping[str, Iterable[str]], *, anyhow: bool = False) -> Any:
    """Return phrases as data: by language, or as a list if they serve all languages.

    `anyhow` is true for phrases that match even if a visitor negates them; it becomes a key of its own.
    """
    if set(table) == {""} and not anyhow:
        return list(table[""])
    return {language: list(rows) for language, rows in table.items()} | ({"anyhow": True} if anyhow else {})


def plain_properties(machine: MachineDefinition) -> dict[str, dict[str, Any]]:
    """Return the properties of a machine as the data under `properties`."""
    found = {}
    for one in machine.properties:
        conditions = {"always": one.always, "whenever": one.whenever, "eventually": one.eventually}
        row: dict[str, Any] = {key: condition.shown for key, condition in conditions.items() if condition}
        found[one.name] = {**row, "within": duration(one.within)} if one.eventually else row
    return found


def plain_action(action: Action) -> ActionData:
    """Return one action as data: an object with its verb as the key."""
    match action:
        case SayText(texts, gestures):
            return {"say": {**_say(texts), **({"gestures": gestures} if gestures else {})}}
        case PublishBody(route, body):
            return {"publish": route if body is None else {"route": route, "body": plain_value(body)}}
        case Assign(values):
            return {"assign": {key: plain_value(value) for key, value in values.items()}}
        case Raise(event, data):
            return {"raise": _event(event, data)}
        case Send(event, data, delay, id, to):
            extra = ({"to": to} if to else {}) | _delay(delay) | ({"id": id} if id else {})
            body = _event(event, data)
            return {"send": {**(body if isinstance(body, dict) else {"event": body}), **extra} if extra else body}
        case CancelSend(id):
            return {"cancel": id}
        case Wait(seconds):
            return {"wait": duration(seconds * 1000)}
        case LogText(template):
            return {"log": as_written(template.text)}
        case If(guard, then, otherwise):
            block: dict[str, Any] = {"if": as_written(guard.source), "then": plain_block(then)}
            return block | ({"else": plain_block(otherwise)} if otherwise else {})
        case AskQuestion(question, within, otherwise):
            row = {"question": as_written(question.source), "within": duration(within * 1000)}
            return {"ask": row | {"else": plain_block(otherwise)}}
        case Parallel(branches):
            return {"parallel": plain_block(branches)}
        case _:
            verb = verb_of(action)
            return {verb.name: verb.data(action, _written)}


def _written(quantity: Quantity, value: Any) -> Any:
    match quantity:
        case Quantity.PLAIN | Quantity.TEMPLATE | Quantity.LENGTH | Quantity.ANGLE:
            return value
        case Quantity.DURATION:
            return duration(value * 1000)
        case _:
            assert_never(quantity)


def single(rows: list[TransitionData]) -> Any:
    """Return the rows in their shortest form: a row with only one target becomes a text, one row alone has no list."""
    shown = [row["target"] if set(row) == {"target"} and isinstance(row["target"], str) else row for row in rows]
    return shown[0] if len(shown) == 1 else shown


def quoted(value: Any) -> Any:
    """Return data that evaluates to this JSON: each text becomes an expression for it, infinity and NaN become None."""
    match value:
        case str():
            return unparse(Literal(value))
        case list():
            return [quoted(item) for item in value]
        case Mapping():
            return {str(key): quoted(item) for key, item in value.items()}
        case float() if not isfinite(value):
            return None
    return value


def _event(event: str, data: ComputedValue) -> Any:
    return event if data is None else {"event": event, "data": plain_value(data)}


def _say(texts: Mapping[str, tuple[Any, ...]]) -> dict[str, Any]:
    table = {
        language or "any": [as_written(template.text) for template in templates]
        for language, templates in texts.items()
    }
    return {language: said[0] if len(said) == 1 else said for language, said in table.items()}


def _delay(delay: float | Template) -> dict[str, str]:
    if isinstance(delay, Template):
        return {"delay": delay.shown}
    return {"delay": duration(delay * 1000)} if delay else {}
