"""Objects of dataclasses are read from data by the names and the annotations of their fields."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any, Literal

import pytest

from lumen.features.console.settings import ConsoleSettings
from lumen.features.fleet.settings import Fleet, FleetGroup, FleetHouse, FleetMeasure
from lumen.features.show.settings import AddressMapping, DmxLink, MqttLink, OscLink, Show, TopicMapping
from lumen.language.buttons import Button
from lumen.language.gestures import GestureLibrary
from lumen.language.house import RobotSpec
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.roles import Base, EyeRoles
from lumen.project.sections import read_fields
from tests import ROOT
from tests.tables import for_each


class Colour(StrEnum):
    RED = "red"


@dataclass(frozen=True)
class Lamp:
    name: str
    channel: int = 0
    dims: bool = False


@dataclass(frozen=True)
class Hall:
    brightness: float = 0.5
    port: int | None = None
    colour: Colour = Colour.RED
    mood: Literal["calm", "lively"] = "calm"
    words: tuple[str, ...] = ()
    first: Lamp | None = None
    lamps: Mapping[str, Lamp] = field(default_factory=dict)
    scenes: Mapping[str, Mapping[str, tuple[int, ...]]] = field(default_factory=dict)
    anything: Any = None


READ = {
    "nothing": ({}, Hall()),
    "key of no field": ({"beside": 1}, Hall()),
    "empty key": ({"words": None}, Hall()),
    "whole number as a float": ({"brightness": 1}, Hall(brightness=1)),
    "float as a whole number": ({"port": 80.0}, Hall(port=80)),
    "member": ({"colour": "red"}, Hall(colour=Colour.RED)),
    "literal": ({"mood": "lively"}, Hall(mood="lively")),
    "list": ({"words": ["a", "b"]}, Hall(words=("a", "b"))),
    "one text for a list": ({"words": "ab"}, Hall(words=("ab",))),
    "map of maps": ({"scenes": {"dusk": {"left": [1, 2.0]}}}, Hall(scenes={"dusk": {"left": (1, 2)}})),
    "dataclass": ({"first": {"name": "a", "dims": True}}, Hall(first=Lamp("a", dims=True))),
    "dataclass that lacks a key": ({"first": {"channel": 3}}, Hall()),
    "short form": ({"lamps": {"a": "Ada", "b": {"name": "Bo"}}}, Hall(lamps={"a": Lamp("Ada"), "b": Lamp("Bo")})),
    "anything": ({"anything": [1, {"a": None}]}, Hall(anything=[1, {"a": None}])),
}


@for_each("what", READ)
def test_a_field_is_read_by_its_annotation(what: str) -> None:
    data, expected = READ[what]
    found = read_fields(Hall, data)
    assert found == expected
    assert type(found.port) is type(expected.port)


def test_a_given_field_is_not_read() -> None:
    assert read_fields(Lamp, {"name": "read", "channel": "not a number"}, channel=7) == Lamp("read", 7)


def test_a_missing_key_is_a_fault_of_the_schema() -> None:
    with pytest.raises(TypeError, match="name"):
        read_fields(Lamp, {})


SHOW, FLEET, ROLES = "modules/properties/show/properties", "fleet", "roles/properties"
SCHEMAS = {
    Show: (f"lumen properties/{SHOW}", {"here"}),
    MqttLink: (f"lumen properties/{SHOW}/mqtt/properties", set()),
    TopicMapping: (f"lumen properties/{SHOW}/mqtt/properties/routes/additionalProperties/properties", set()),
    OscLink: (f"lumen properties/{SHOW}/osc/properties", set()),
    AddressMapping: (f"lumen properties/{SHOW}/osc/properties/routes/additionalProperties/properties", set()),
    DmxLink: (f"lumen properties/{SHOW}/dmx/properties", set()),
    ConsoleSettings: ("lumen properties/console/properties", set()),
    RobotSpec: ("lumen properties/robots/additionalProperties/properties", set()),
    Fleet: (f"{FLEET} properties", {"description"}),
    FleetHouse: (f"{FLEET} $defs/house/properties", set()),
    FleetGroup: (f"{FLEET} $defs/group/properties", set()),
    FleetMeasure: (f"{FLEET} $defs/measure/properties", set()),
    Button: ("behavior $defs/button/properties", {"actions"}),
    Passage: ("knowledge properties", {"as-of", "description"}),
    QuestionSet: ("questions properties", {"description"}),
    GestureLibrary: ("gestures properties", {"units", "description"}),
    Base: (f"body properties/{ROLES}/base/properties", set()),
    EyeRoles: (f"body properties/{ROLES}/eyes/properties", set()),
}
"""The places in the schemas of the keys of each dataclass, and the keys that its builder reads under another name."""


@for_each("kind", SCHEMAS)
def test_each_key_of_the_schema_is_a_field(kind: type) -> None:
    where, others = SCHEMAS[kind]
    name, path = where.split()
    node = json.loads((ROOT / f"schemas/{name}.schema.json").read_text())
    for step in path.split("/"):
        node = node[step]
    assert node.keys() - {each.name for each in fields(kind)} == others
