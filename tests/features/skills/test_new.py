"""`lumen new skill NAME` writes files that lint, run and are tested at once; a stranger's `blink` needs two files."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from tests import ROOT
from tests.copying import copied_project
from tests.features.skills.changing import found
from tests.tables import for_each


@pytest.fixture
def hall(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    monkeypatch.chdir(root)
    return root


@pytest.mark.process
def test_a_new_skill_lints_and_is_tested_without_and_with_its_code(
    hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "skill", "wobble"]) == 0
    assert "lumen test try_wobble" in capsys.readouterr().out
    assert found(hall) == []
    assert main(["test"]) == 0
    assert main(["test", "try_wobble", "--real-skills", "--verbose"]) == 0
    assert "wobble: 2 of 2" in capsys.readouterr().out
    assert main(["run", "--story", "try_wobble", "--robot", "recording", "--speed", "max"]) == 0
    assert "does wobble with times 2" in capsys.readouterr().out


@for_each(
    ("words", "reason"),
    [
        (["skill"], "write `lumen new skill NAME`"),
        (["skill", "say"], "there is a verb `say` already"),
        (["skill", "Fog-Machine"], "`Fog-Machine` can't be the name of a skill"),
        (["skil", "fog"], "can't add a `skil` to a project: did you mean `skill`?"),
    ],
)
def test_what_cannot_be_made_is_refused(words: list[str], reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", *words]) == 2
    assert reason in capsys.readouterr().err


def test_a_file_that_is_there_stays_as_it_is(hall: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (hall / "skills").mkdir()
    (hall / "skills/fog.py").write_text("mine", "utf-8")
    assert main(["new", "skill", "fog"]) == 2
    assert "skills/fog.py exists already" in capsys.readouterr().err
    assert [file.name for file in (hall / "skills").iterdir()] == ["fog.py"]


BLINK = """\
description: Blinks with the eyes
in: {required: [times], properties: {times: {type: integer, minimum: 1}}}
out: {properties: {blinked: {type: integer, default: 2}}}
takes: "{{ times * 0.5 }}s"
performed-by: {python: skills/blink.py}
"""
CODE = """\
from lumen.skills import skill


@skill
def blink(call, times):
    for done in range(times):
        print("blinks")
        if not call.wait(0.5):
            return {"blinked": done}
    return {"blinked": times}
"""


def blinking(hall: Path) -> Path:
    """Add `blink` to a project that was empty, and let its behaviour blink three times; return the behaviour."""
    (hall / "skills").mkdir()
    (hall / "skills/blink.yaml").write_text(BLINK, "utf-8")
    (hall / "skills/blink.py").write_text(CODE, "utf-8")
    hello = hall / "behaviors/hello.yaml"
    hello.write_text(hello.read_text("utf-8").replace("{play: wave}", "{blink: 3}"), "utf-8")
    return hello


def test_a_strangers_mistake_is_found_at_its_word(hall: Path) -> None:
    hello = blinking(hall)
    hello.write_text(hello.read_text("utf-8").replace("{blink: 3}", "{blink: {time: 3}}"), "utf-8")
    [line] = found(hall)
    assert line.startswith("behaviors/hello.yaml:12:19 unknown-key")
    assert "did you mean `times`?" in line


@pytest.mark.process
def test_a_strangers_verb_ends_with_the_state_that_is_left(hall: Path, capsys: pytest.CaptureFixture[str]) -> None:
    hello = blinking(hall)
    left = "    onDone: waiting\n    after: {800ms: waiting}\n"
    hello.write_text(hello.read_text("utf-8").replace("    onDone: waiting\n", left), "utf-8")
    steps = (
        "[{visitor: arrives}, {expect: {state: greeting}}, {says: Goodbye!}, {expect: {state: goodbye}}, {wait: 2s}]"
    )
    (hall / "behaviors/stories/visitor.yaml").write_text(f"steps: {steps}\n", "utf-8")
    assert main(["test", "--real-skills", "--verbose"]) == 0
    shown = capsys.readouterr().out
    assert "ends early: does blink with times 3" in shown
    assert shown.count("blinks") == 2


@pytest.mark.process
def test_a_stranger_adds_a_verb_in_two_files_of_at_most_thirty_lines(
    hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert len((BLINK + CODE).splitlines()) <= 30
    blinking(hall)
    story = hall / "behaviors/stories/visitor.yaml"
    story.write_text(story.read_text("utf-8").replace("played: wave", "did: {blink: 3}"), "utf-8")
    assert found(hall) == []
    assert main(["test", "--real-skills", "--verbose"]) == 0
    assert capsys.readouterr().out.count("blinks") == 3
    assert main(["run", "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    assert main(["replay"]) == 0
    assert "1 the same" in capsys.readouterr().out
    assert main(["why", "blink"]) == 0
    assert "blink with times 3" in capsys.readouterr().out
