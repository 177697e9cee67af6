"""A stranger's verb reads the stranger's section of lumen.yaml, also after a reload and in another process."""

import json
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.feature import resolve
from lumen.insight.migration import MigrationPlan
from lumen.language.command_data import command_data, from_trace, traced
from lumen.language.commands import Do, Start
from lumen.language.projects import Project
from lumen.robot.command_codec import decode_command, encode_command
from lumen.run.exhibition import Exhibition
from tests.stranger.test_sections import LAMP
from tests.waiting import until

BEHAVIOR = """\
context: {brightness: 0, failure: ""}
events: {again: null}
initial: shining
states:
  shining:
    do: {shine: night}
    onDone: {target: bright, actions: {assign: {brightness: event.data.brightness}}}
    onError: {target: dark, actions: {assign: {failure: event.data.reason}}}
  bright: {on: {again: shining}}
  dark: {}
"""


@pytest.fixture
def lamps(stranger: Path, hall: Path) -> Path:
    """A project whose robot switches the stranger's lamp."""
    main = hall / "lumen.yaml"
    main.write_text(f"{main.read_text()}{LAMP}")
    (hall / "behaviors/hello.yaml").write_text(BEHAVIOR)
    (hall / "behaviors/stories/visitor.yaml").write_text("title: It shines\nsteps: [{expect: {state: shining}}]\n")
    return hall


def changed(lamps: Path, old: str, new: str) -> Project:
    """Return the project after a change of lumen.yaml."""
    text = (lamps / "lumen.yaml").read_text()
    assert old in text
    (lamps / "lumen.yaml").write_text(text.replace(old, new))
    return lumen.load(lamps)


def live(exhibition: Exhibition, key: str, value: Any) -> None:
    """Let an exhibition run until a key of the behaviour's context has that value."""
    until(lambda: exhibition.context[key] == value, meanwhile=lambda: exhibition.run(seconds=0.1))


def test_a_verb_reads_the_section_of_the_current_files(lamps: Path) -> None:
    with lumen.open(lamps, robot="teddy") as exhibition:
        live(exhibition, "brightness", 0.1)
        project = changed(lamps, "night: 0.1", "night: 0.3")
        plan = exhibition.behavior.plan(project, now=True)
        assert isinstance(plan, MigrationPlan)
        exhibition.behavior.apply(project, plan)
        exhibition.loop.happen(lumen.Event("again"))
        live(exhibition, "brightness", 0.3)


def test_a_scene_that_the_section_lacks_is_an_answer(lamps: Path) -> None:
    changed(lamps, "first: night, scenes: {night: 0.1,", "scenes: {")
    with lumen.open(lamps, robot="teddy") as exhibition:
        live(exhibition, "failure", "the lamp has no scene `night`")


def test_a_robot_in_another_process_adds_the_sections_of_its_own_files(lamps: Path) -> None:
    project = lumen.load(lamps)
    body = json.loads(json.dumps(encode_command(Do("shine", {"scene": "night"}))))
    command = decode_command(body, project)
    assert isinstance(command, Do)
    assert command.sections == {"lamp": project.section(resolve("lumen_stranger.lamp:Lamp"))}


def test_no_journal_and_no_message_contains_a_section(lamps: Path) -> None:
    command = Start("d1", Do("shine", {"scene": "night"}, lumen.load(lamps).sections))
    assert command_data(command) == {
        "Start": {"id": "d1", "command": {"Do": {"skill": "shine", "arguments": {"scene": "night"}}}}
    }
    said = traced(command)
    assert said == {"verb": "do", "id": "d1", "skill": "shine", "arguments": {"scene": "night"}}
    assert from_trace(said) == command
    assert encode_command(command.command)["parameter"] == {"skill": "shine", "arguments": {"scene": "night"}}
