"""One row for each verb and each sense: after an addition, a test fails for each part that does not know it yet."""

import json
from dataclasses import fields
from pathlib import Path
from typing import Any, get_args

import pytest

from lumen.bus.memory import MemoryBus
from lumen.feature import table
from lumen.insight.changes.actions import described
from lumen.language.actions import Action, ComputedAction
from lumen.language.body_parts import PARTS
from lumen.language.commands import (
    BodyCommand,
    Command,
    Do,
    GoTo,
    Leds,
    Look,
    Move,
    Play,
    PlaySound,
    Posture,
    Rest,
    Say,
    Start,
    Stop,
    VerbCommand,
    Volume,
    Wake,
)
from lumen.language.commands import Walk as WalkTo
from lumen.language.events import Event
from lumen.language.life import STILL_STYLE
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.routes import route_meanings
from lumen.language.verbs import COMPUTED, VERBS, Quantity, verb_of
from lumen.ports import (
    Aim,
    Battery,
    Joints,
    Live,
    NumericReading,
    Perform,
    Reading,
    Record,
    RobotCommand,
    Sense,
    Sonar,
    Tactile,
    Whereabouts,
)
from lumen.project.actions import COMPUTED_READERS
from lumen.project.formats.behavior_data import plain_action
from lumen.project.schema import load_schema
from lumen.robot.command_codec import decode_command, encode_command
from lumen.robot.command_table import COMMANDS, row_of
from lumen.robot.recording import RecordingRobot
from lumen.robot.sense_codec import decode_reading, encode_reading
from lumen.run.trace_publisher import TracePublisher
from lumen.run.trace_subscriber import TraceSubscriber
from lumen.statechart import Machine
from tests import ROOT
from tests.exhibits import BODY, project
from tests.tables import for_each

ACTION = load_schema("behavior")["$defs"]["action"]["properties"]
DURATIONS = {"$ref": "#/$defs/duration"}

SAMPLES: tuple[RobotCommand, ...] = (
    Say("hello", "en"),
    Perform(MotionDefinition("nod", 1.0, {"HeadPitch": (Keyframe(1.0, 0.1),)})),
    Posture("Stand", 0.8),
    WalkTo(0.2, -0.1, 0.5),
    Move(0.05, 0.0, 0.1),
    Look(0.3, -0.1),
    Leds({"eyes": "rebeccapurple", "left_foot": "#12a0ff"}, 0.5),
    Volume(0.6),
    PlaySound("sounds/bell.wav", 1.5),
    Aim({"HeadYaw": 0.2}, 0.4),
    Record("voice", 2.0),
    Live(STILL_STYLE),
    Stop("say"),
    Rest("Ada"),
    Wake(),
)
"""Each command that robots perform."""

READINGS: tuple[NumericReading, ...] = (
    Joints(
        1.0,
        tuple(BODY.joints),
        (0.1,) * len(BODY.joints),
        (1.0,) * len(BODY.joints),
        position=Whereabouts(1.0, -0.5, 0.3, 0.04),
    ),
    Sonar(1.0, 0.5, 2.5),
    Tactile(1.0, BODY.tactile, (1,) * len(BODY.tactile)),
    Battery(1.0, 80, plugged=True, charging=False),
)


def examples() -> list[tuple[str, Any]]:
    """Return the schema's examples of each verb; for a verb of fixed values those values."""
    found = []
    for name in (*COMPUTED.values(), *(verb.name for verb in VERBS)):
        schema = ACTION.get(name, {})
        values = schema.get("examples", schema.get("enum", []))
        found += [(name, value) for value in values if name not in ("if", "then", "else")]
    return list({json.dumps(pair): pair for pair in found}.values())


def loaded(name: str, data: Any) -> Action:
    """Return the action that Lumen loads from this YAML."""
    root: dict[str, Any] = {"id": "m", "context": dict.fromkeys(("visitor", "asked"), 0)}
    events = {"bored": {"type": "object"}, "enough": {"type": "object"}}
    state = {"do": [{name: data}], "on": dict.fromkeys(events, "a")}
    return Machine.from_dict({**root, "events": events, "states": {"a": state}}, "m").states["a"].do[0].action


def test_every_action_has_one_row() -> None:
    assert {verb.command for verb in VERBS} == set(get_args(VerbCommand)) - {Do}  # tests/stranger_verbs is about it
    assert set(COMPUTED) == set(get_args(ComputedAction))
    assert len(VERBS) + len(COMPUTED) + len([Do]) == len(get_args(Action))
    assert (
        {type(sample) for sample in SAMPLES} | {Do} == {row.command for row in COMMANDS} == set(get_args(RobotCommand))
    )


@for_each("verb", VERBS, ids=lambda verb: verb.command.__name__)
def test_the_fields_of_a_row_are_those_of_the_command_and_of_the_schema(verb: Any) -> None:
    assert [field.name for field in verb.fields] == [
        field.name for field in fields(verb.command) if field.metadata.get("yaml", True)
    ]
    said = ACTION[verb.name].get("properties", {})
    if said:
        rows = [other for other in VERBS if other.name == verb.name]
        named = [field for row in reversed(rows) for field in row.fields if not field.others]
        others = any(field.others for field in verb.fields)
        assert list(said)[-len(named) :] == [field.name for field in named]
        assert others == (len(said) > len(named))
        for field in (field for field in verb.fields if not field.others):
            measured = field.quantity in (Quantity.LENGTH, Quantity.ANGLE)
            assert (field.quantity is Quantity.DURATION) == (said[field.name].items() >= DURATIONS.items())
            assert not measured or said[field.name]["type"] == "number"
    assert verb.instant == (verb.command not in get_args(RobotCommand)) or verb.command in (Play, GoTo)


def test_the_schemas_the_loader_and_the_docs_know_every_verb() -> None:
    names = {verb.name for verb in VERBS} | set(COMPUTED.values())
    assert set(ACTION) == names | {"then", "else"}
    assert set(COMPUTED_READERS) == set(COMPUTED.values()) - {"if"}
    performed = load_schema("story")["properties"]["robot"]["propertyNames"]["enum"]
    assert set(performed) == {verb.name for verb in VERBS} | {"say"}
    documented = Path(ROOT, "docs/yaml.md").read_text("utf-8")
    assert [name for name in names if f"`{name}" not in documented] == []
    assert [name for name in ACTION if not ACTION[name].get("description")] == ["if"]  # it describes an expression


@for_each(("name", "data"), examples())
def test_what_the_yaml_says_is_read_and_written_and_read_again(name: str, data: Any) -> None:
    action = loaded(name, data)
    written = plain_action(action)
    assert list(written) == [name]
    assert loaded(name, written[name]) == action
    assert described(action).endswith(tuple("abcdefghijklmnopqrstuvwxyz`”0123456789"))
    if isinstance(action, VerbCommand):
        assert verb_of(action).transcript(action)


class Heard:
    """Observes a behaviour from another process."""

    def __init__(self) -> None:
        self.commands: list[Command] = []

    def see(self, *_: object) -> None: ...

    def answered(self, event: Event) -> None: ...

    def performing(self, command: Command, now: float) -> None:
        self.commands.append(command)


def body_commands() -> list[BodyCommand]:
    written = [loaded(name, data) for name, data in examples()]
    return [Say("hello", "en"), *(action for action in written if isinstance(action, VerbCommand))]


@for_each("command", body_commands(), ids=str)
def test_who_watches_from_another_process_sees_every_command(command: BodyCommand) -> None:
    exhibit, bus, heard = project(), MemoryBus(), Heard()
    subscriber = TraceSubscriber(exhibit, bus, lambda _: None)
    subscriber.watchers.append(heard)
    TracePublisher(bus, lambda: exhibit, lambda: 0.0).performing(Start("c1", command), 0.0)
    subscriber.tick(0.0)
    assert heard.commands == [Start("c1", command)]


@for_each("command", SAMPLES, ids=lambda command: type(command).__name__)
def test_every_command_crosses_the_bus(command: RobotCommand) -> None:
    assert decode_command(json.loads(json.dumps(encode_command(command))), project()) == command


@for_each("command", SAMPLES, ids=lambda command: type(command).__name__)
def test_the_recording_robot_performs_every_command(command: RobotCommand) -> None:
    row, robot = row_of(command), RecordingRobot(BODY)
    assert row.parts(command, BODY) <= set(PARTS)
    robot.start("c1", command)
    robot.advance(0.01)
    robot.advance(min(row.duration(command), 60.0) + 0.01)
    if not isinstance(command, Aim | Live | Move):
        assert [event.name for event in robot.poll() if "command" in event.name] == ["done.command.c1"]


def test_every_sense_has_a_meaning_a_reading_and_a_body() -> None:
    assert {sense.value for sense in Sense} <= route_meanings().keys()
    assert {type(reading) for reading in READINGS} == set(get_args(NumericReading))
    assert len(get_args(Reading)) == len(Sense)
    assert set(table("senses")) == set(Sense)
    robot = RecordingRobot(BODY)
    for sense in Sense:
        reading = robot.read(sense)
        assert (reading is None) == (sense is Sense.IMAGE)
        assert (Path(ROOT, "schemas/messages") / f"{sense}.schema.json").is_file()


@pytest.mark.parametrize("reading", READINGS, ids=lambda reading: type(reading).__name__)
def test_every_reading_crosses_the_bus(reading: NumericReading) -> None:
    senses = [sense for sense in Sense if isinstance(RecordingRobot(BODY).read(sense), type(reading))]
    body = json.loads(json.dumps(encode_reading(senses[0], reading)))
    assert [decode_reading(sense, body, tuple(BODY.joints)) for sense in senses] == [reading]
