"""The robot's lights: groups and colours that behaviours, motions, schemas and robots have in common."""

import json
from typing import Any

import pytest
from PIL import ImageColor

import lumen
from lumen.features.naoqi.hardware import NAO, PEPPER
from lumen.features.naoqi.lights import NAOQI_COLOURS, fades
from lumen.features.simulation.lights import RENDERED_COLOURS, rendered
from lumen.language.lights import COLOURS, LIGHT_GROUPS, LIGHTS, light_fault, rgb
from lumen.project.schema import load_schema
from tests.tables import for_each


def test_the_colours_are_those_of_css() -> None:
    css = {name: value for name, value in COLOURS.items() if name != "off"}
    assert len(css) == 148
    assert css == {name: int(ImageColor.colormap[name][1:], 16) for name in ImageColor.colormap}  # type: ignore[index]


@pytest.mark.parametrize(("colour", "value"), [("#12A0ff", 0x12A0FF), ("rebeccapurple", 0x663399), ("off", 0)])
def test_a_colour_is_a_name_or_six_digits(colour: str, value: int) -> None:
    assert rgb(colour) == value


@for_each("colour", ["#12g", "#12a0fg", "12a0ff", "#12a0ff ", "Blue", "", 5, None, ["blue"]])
def test_anything_else_is_no_colour(colour: object) -> None:
    assert rgb(colour) is None
    assert light_fault("eyes", colour)


def test_what_is_wrong_comes_with_what_would_be_right() -> None:
    assert light_fault("eyes", "blue") == ""
    assert light_fault("eyes", "bleu") == "there is no colour `bleu`: did you mean `blue`?"
    assert light_fault("eye", "blue").startswith("there is no light `eye`: did you mean `eyes`?")
    assert light_fault("eyes", "#12g") == "`#12g` is not a colour: write a name, or # and six digits, as in `#12a0ff`"


def test_both_robots_and_motions_have_the_same_groups_and_colours() -> None:
    assert NAO.lights.keys() == LIGHT_GROUPS.keys() == {*LIGHTS, "eyes", "ears", "feet"}
    assert PEPPER.lights.keys() < NAO.lights.keys()
    assert {*NAOQI_COLOURS, *RENDERED_COLOURS} <= COLOURS.keys()
    assert set(groups(load_schema("motion"))) == LIGHT_GROUPS.keys()
    behavior = load_schema("behavior")
    assert set(groups(behavior)) == {*LIGHT_GROUPS, "duration"}
    assert behavior["$defs"]["colour_name"]["enum"] == list(COLOURS)


def test_a_colour_by_name_is_drawn_and_sent_as_it_looks_on_leds() -> None:
    assert rendered("blue") != rendered("#0000ff") == (0.0, 0.0, 1.0)
    assert rendered("bleu") is None
    assert list(fades({"chest": "orange", "eyes": "coral", "nose": "red", "head": "bleu"}, lumen.load().body)) == [
        ("ChestLeds", 0xFF6000, 0.05),
        ("FaceLeds", 0xFF7F50, 0.05),
    ]


def groups(schema: Any) -> dict[str, Any]:
    """Return the properties of the first `leds` in a schema."""
    if '"leds"' not in json.dumps(schema):
        return {}
    if isinstance(schema, dict) and "leds" in schema:
        found: dict[str, Any] = schema["leds"]["properties"]
        return found
    inner = schema.values() if isinstance(schema, dict) else schema
    return next(found for part in inner if (found := groups(part)))
