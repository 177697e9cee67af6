"""Only bodies that fit their route cross the boundary, in either direction."""

import logging
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from lumen.bus import BusError, connect
from lumen.bus.checking import SchemaCheck
from lumen.expressions.json_schema import JsonSchema
from lumen.language.causes import MessageOrigin
from lumen.language.routes import Direction, Route
from lumen.ports import Message
from tests.exhibits import messages, project
from tests.tables import for_each
from tests.waiting import Collector

FACE = "lumen.visual.face.detection"
SCHEMAS = messages()


def test_a_body_of_ours_that_does_not_fit_is_our_own_fault() -> None:
    bus = connect("memory://", project())
    with pytest.raises(BusError, match=r"lumen\.visual\.face\.detection.*x: 'left' is not of type 'integer'"):
        bus.publish(FACE, {"x": "left", "y": 1})
    with pytest.raises(BusError, match="'y' is a required property"):
        bus.publish(FACE, {"x": 1})


def test_a_body_that_nests_without_end_is_refused_before_anybody_looks_into_it() -> None:
    body: Any = 1
    for _ in range(50_000):
        body = [body]
    bus = connect("memory://", project())
    for key in (FACE, "lumen.motion.head"):
        with pytest.raises(BusError, match="nested"):
            bus.publish(key, body)


def test_a_wrong_body_that_comes_in_is_reported_and_goes_no_further(address: str) -> None:
    seen, refused = Collector(), []
    bus = connect(address, project(), on_refused=lambda key, reason: refused.append((key, reason)))
    bus.subscribe("lumen.#", seen)
    stranger = connect(address)
    stranger.publish(FACE, {"x": 1, "y": None})
    stranger.publish(FACE, {"x": 1, "y": 2, "confidence": 0.9})
    assert seen.bodies == [{"x": 1, "y": 2, "confidence": 0.9}]
    assert refused == [(FACE, "y: None is not of type 'integer'")]


def test_a_refusal_is_logged_where_nobody_else_is_told(address: str, caplog: pytest.LogCaptureFixture) -> None:
    bus = connect(address, project())
    bus.subscribe(FACE, Collector())
    with caplog.at_level(logging.WARNING):
        connect(address).publish(FACE, "here")
    assert f"a message on `{FACE}` was refused: 'here' is not of type 'object'" in caplog.text


@pytest.mark.parametrize("key", ["visitor.here", "", "lumenary.x", "Avatar.NAO"])
def test_keys_of_no_route_begin_with_avatar_or_lumen(key: str) -> None:
    bus = connect("memory://", project())
    with pytest.raises(BusError, match=r"no route .* has this key"):
        bus.publish(key, 1)


def test_a_route_may_have_any_key() -> None:
    lamp = Route("lamp", "museum.{robot}.lamp", Direction.OUT)
    before = project()
    bus, seen = connect("memory://", replace(before, routes={**before.routes, "lamp": lamp})), Collector()
    bus.subscribe("museum.*.lamp", seen)
    bus.publish("museum.NAO.lamp", {"level": 0.5})
    assert seen.bodies == [{"level": 0.5}]


def test_a_key_without_a_route_passes() -> None:
    bus, seen = connect("memory://", project()), Collector()
    bus.subscribe("#", seen)
    bus.publish("lumen.motion.head", {"anything": [1]})
    bus.publish("avatar.PEPPER.data.joint", "another robot's")
    assert seen.bodies == [{"anything": [1]}, "another robot's"]


def test_a_reason_holds_no_picture() -> None:
    bus = connect("memory://", project())
    with pytest.raises(BusError) as caught:
        bus.publish("avatar.NAO.data.image", {"name": "1", "contentType": "image/jpeg", "contentUrl": "x" * 100_000})
    assert len(str(caught.value)) < 400


def test_another_bundle_brings_its_own_schemas() -> None:
    before = project()
    after = replace(before, messages={**before.messages, "face.detection": {"type": "string"}})
    bus, seen = connect("memory://", before), Collector()
    bus.subscribe(FACE, seen)
    bus.use(after)  # type: ignore[attr-defined]
    bus.publish(FACE, "in the middle")
    assert seen.bodies == ["in the middle"]


def test_what_is_on_its_way_as_another_bundle_comes_has_to_fit_that() -> None:
    before = project()
    after = replace(before, messages={**before.messages, "face.detection": {"type": "string"}})
    refused: list[str] = []
    bus, first, second = connect("memory://", before, on_refused=lambda _, why: refused.append(why)), [], Collector()

    def take(message: Message) -> None:
        first.append(message.body)
        bus.use(after)  # type: ignore[attr-defined]

    bus.subscribe(FACE, take)
    bus.subscribe(FACE, second)
    bus.publish(FACE, {"x": 1, "y": 2})
    assert (first, second.bodies) == ([{"x": 1, "y": 2}], [])
    assert refused == ["{'x': 1, 'y': 2} is not of type 'string'"]


def test_a_message_of_ours_is_checked_once_and_one_of_somebody_else_by_each_subscriber(
    address: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    checked, fits = [], JsonSchema.fits
    monkeypatch.setattr(JsonSchema, "fits", lambda self, body: checked.append(body["x"]) or fits(self, body))
    bus, stranger, seen = connect(address, project()), connect(address), Collector()

    def answer(message: Message) -> None:
        seen(message)
        if message.body["x"] == 1:
            bus.publish(FACE, {"x": 2, "y": 2})

    bus.subscribe(FACE, answer)
    bus.subscribe(FACE, seen)
    bus.publish(FACE, {"x": 3, "y": 2})
    assert checked == [3]
    stranger.publish(FACE, {"x": 4, "y": 2}, origin=MessageOrigin(id=seen.messages[-1].id[:-1] + "0"))
    assert checked == [3, 4, 4]
    bus.publish(FACE, {"x": 1, "y": 2})  # whose first subscriber says something else before the second one has it
    assert [body["x"] for body in seen.bodies] == [3, 3, 4, 4, 1, 1, 2, 2]
    assert set(checked[3:]) == {1, 2}


def test_a_reply_needs_no_key_of_ours(address: str) -> None:
    bus, plain, seen = connect(address, project()), connect(address), Collector()
    plain.subscribe("answers", seen)
    bus.subscribe("avatar.NAO.command", lambda message: bus.reply(message, "command finished"))
    plain.publish("avatar.NAO.command", {"method": "rest"}, reply_to="answers", correlation_id="1")
    assert [(m.body, m.correlation_id) for m in seen.messages] == [("command finished", "1")]


BODIES_OF_2015: list[tuple[str, Any]] = [
    ("sonar", {"rightSensor": 0.5, "leftSensor": 2.55}),
    ("battery", {"percentage": 80, "isPlugged": False, "isCharging": False}),
    ("joint", {"name": ["LHipPitch "], "angle": [0.1], "stiffness": [1]}),
    ("tactile", {"name": ["RightBumper"], "value": [0]}),
    ("recording", {"name": "a", "content": "UklGRg=="}),
    ("command", {"type": "motion", "Method": "moveTo", "parameter": {"x": 0.2, "y": 0, "tetha": 0}}),
    ("command", {"type": "Motion", "method": "wakeup", "parameter": None}),
    ("speech.recognition", {"name": "speech", "result": "hello", "date": "2015-06-01"}),
    ("gender.identification", {"name": "a", "gender": "female"}),
    ("wav.stream", {"name": "a", "content": "UklGRg==", "language": "en"}),
    ("text.stream", {"name": "a", "text": "hello", "date": "x"}),
    ("text.to.speech", {"name": "a", "sound": "UklGRg==", "date": "x"}),
    ("face.detection", {"x": 160, "y": 120}),
    ("human.detection", {"x": 160, "y": 120}),
    ("face.tracking", {"x": 160.5, "y": 120.25}),
    ("face.recognition", {"name": "unknown"}),
]


@for_each(("name", "body"), BODIES_OF_2015)
def test_the_bodies_of_2015_fit_and_may_hold_more(name: str, body: dict[str, Any]) -> None:
    check = SchemaCheck(SCHEMAS[name])
    assert check(body) == ""
    assert check({**body, "more": 1}) == ""
    assert check([body]) != ""


@for_each("schema", SCHEMAS.values(), ids=SCHEMAS)
def test_message_schemas_are_schemas_and_say_what_they_are(schema: dict[str, Any]) -> None:
    Draft202012Validator.check_schema(schema)
    assert schema["title"]
    assert all(p["description"] for p in schema["properties"].values())


TEXTS = st.sampled_from(["", "male", "data:image/jpeg;base64,"])
SCALARS = st.none() | st.booleans() | st.integers(-2, 400) | st.floats(-1, 2) | TEXTS
VALUES = st.recursive(SCALARS, lambda v: st.lists(v, max_size=3), max_leaves=5)
FIELDS = st.sampled_from(sorted({field for schema in SCHEMAS.values() for field in schema["properties"]}))


@pytest.mark.slow
@given(name=st.sampled_from(sorted(SCHEMAS)), body=st.dictionaries(FIELDS, VALUES, max_size=6) | VALUES)
def test_a_quick_yes_is_never_wrong(name: str, body: Any) -> None:
    assert not JsonSchema(SCHEMAS[name]).fits(body) or Draft202012Validator(SCHEMAS[name]).is_valid(body)


@for_each(("name", "body"), BODIES_OF_2015)
def test_the_usual_bodies_get_a_quick_yes(name: str, body: dict[str, Any]) -> None:
    assert JsonSchema(SCHEMAS[name]).fits(body)


def test_alternatives_hold() -> None:
    schema = {"type": "object", "oneOf": [{"required": ["a"]}, {"required": ["b"]}]}
    assert SchemaCheck(schema)({"a": 1}) == ""
    assert SchemaCheck(schema)({"a": 1, "b": 1}) != ""
