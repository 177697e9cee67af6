"""A project that uses the additions of the stranger's distribution."""

from pathlib import Path

import pytest

from tests import ROOT
from tests.copying import copied_project

MAIN = """
bus: postbox://hall
modules: {mood: {here: true, cheerful: [great, lovely]}}
routes:
  mood: {key: "lumen.{robot}.mood", direction: in, schema: mood, event: cheered}
  honey: {key: "avatar.{robot}.data.honey", direction: in, schema: honey, event: honey, every: 500ms}
  slow_honey: {key: "avatar.{robot}.data.honey.slow", direction: out, of: honey, schema: honey, every: 5s}
"""
MOOD = """{"type": "object", "properties": {"cheer": {"type": "integer"}}, "required": ["cheer"]}"""
HONEY = """{"type": "object", "properties": {"pots": {"type": "integer"}, "time": {"type": "number"}},
"required": ["pots", "time"]}"""
BEHAVIOR = """\
words: common
entry: {wake: true}
states:
  waiting: {on: {face: greeting}}
  greeting:
    do: {say: {en: "{{ shout('hello', 2) }}"}}
    on:
      cheered: {target: laughing, guard: event.data.cheer == 2}
      honey: {target: content, guard: event.data.pots == 2}
    hears: {bye: waiting}
    after: {30s: waiting}
  content:
    on: {cheered: {target: laughing, guard: event.data.cheer == 2}}
    after: {30s: waiting}
  laughing:
    do: [{play: wave}, {say: {en: Ha ha!}}]
    onDone: waiting
    onError: waiting
"""
STORY = """\
title: A visitor is cheerful
steps:
  - visitor: arrives
  - expect: {state: greeting}
  - wait: 2s
  - says: A great and lovely bear
"""


@pytest.fixture
def hall(tmp_path: Path) -> Path:
    """A project with the stranger's bus, module, sense and function."""
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    (root / "lumen.yaml").write_text((root / "lumen.yaml").read_text() + MAIN)
    (root / "behaviors/hello.yaml").write_text(BEHAVIOR)
    (root / "behaviors/stories/visitor.yaml").write_text(STORY)
    (root / "schemas/messages").mkdir(parents=True)
    (root / "schemas/messages/mood.schema.json").write_text(MOOD)
    (root / "schemas/messages/honey.schema.json").write_text(HONEY)
    return root
