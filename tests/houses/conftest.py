"""A house of two robots with the small example's files."""

from pathlib import Path

import pytest

from tests import ROOT
from tests.copying import copied_project

ROBOTS = "robots:\n  ana: {model: nao, at: {y: -0.4}}\n  ben: {model: nao, at: {y: 0.4}}"


@pytest.fixture
def two(tmp_path: Path) -> Path:
    folder = tmp_path / "two"
    copied_project(ROOT / "examples/minimal", folder)
    main = folder / "lumen.yaml"
    text = main.read_text("utf-8")
    assert "robot: {name: NAO, model: nao}" in text
    main.write_text(text.replace("robot: {name: NAO, model: nao}", ROBOTS), "utf-8")
    return folder


STAGE = {
    "lumen.yaml": """lumen: 1
name: Stage
behavior: lead
languages: [en]
robots:
  ana: {model: nao, at: {y: -0.4}}
  ben: {model: nao, at: {y: 0.4}, behavior: follow}
shared:
  stage: {owner: ana, type: string, initial: free}
  seats: {owner: ben, type: integer, initial: 3}
hall: hall.xml
""",
    "behaviors/lead.yaml": """events: {begin: null, end: null}
states:
  free: {entry: {assign: {shared.stage: "'free'"}}, on: {begin: busy}}
  busy: {entry: {assign: {shared.stage: "'busy'"}}, on: {end: free}}
""",
    "behaviors/follow.yaml": """states:
  waiting: {always: {guard: shared.stage == 'busy', target: watching}}
  watching:
    entry: [{assign: {shared.seats: shared.seats - 1}}, {say: "The stage is {{ shared.stage }}"}]
    always: {guard: shared.stage == 'free', target: waiting}
""",
}


@pytest.fixture
def stage(tmp_path: Path) -> Path:
    """Ana has the stage, Ben watches her and counts the seats."""
    for name, text in STAGE.items():
        file = tmp_path / "stage" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return tmp_path / "stage"
