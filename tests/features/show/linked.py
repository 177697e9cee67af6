"""Routes of an exhibition that devices can be linked to, and their messages."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.features.show.module import ShowControl
from lumen.language.routes import Carried, Direction, Route
from tests.features.conftest import Stand

Make = Callable[..., Stand]
LAMP, BUTTON = "museum.lamp.set", "museum.button"
ROUTES = {
    "lamp": Route("lamp", LAMP, Direction.OUT, schema="lamp", carried=Carried.COMMAND, ttl=2.0),
    "mood": Route("mood", "museum.mood", Direction.OUT, schema="mood"),
    "button": Route("button", BUTTON, Direction.IN, schema="button", event="button", most=5.0),
    "fader": Route("fader", "museum.fader", Direction.IN, schema="fader"),
}
FULL = {"type": "number", "minimum": 0, "maximum": 1}
MESSAGES: Mapping[str, Any] = {
    "lamp": {"type": "object", "properties": {"level": FULL, "on": {"type": "boolean"}}},
    "mood": {"type": "object", "properties": {"name": {"type": "string"}}},
    "button": {"type": "object", "properties": {"number": {"type": "integer", "maximum": 9}}, "required": ["number"]},
    "fader": {"type": "object", "properties": {"name": {"type": "string"}, "level": FULL}},
}


def added(here: Stand) -> ShowControl:
    module = ShowControl(here.project, here.bus, here.told.append)
    here.add(module)
    return module
