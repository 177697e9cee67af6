"""Verdicts: equal in two runs, valid for continuous integration, one line for each impossible story."""

import json
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.language.projects import Project
from tests.scanning import matching
from tests.tables import for_each

Write = Callable[..., Path]


def told(arguments: list[str], code: int, capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["test", *arguments]) == code
    return capsys.readouterr().out


@pytest.mark.slow
def test_every_story_has_a_line_and_all_are_counted(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    shown = told([project.root, "shy", "silence"], 0, capsys)
    assert "ok       0:29  shy: Somebody does not tell their name" in shown
    assert "ok       0:34  silence: Somebody looks" in shown
    assert "2 stories, 0 failed: 1:03 of simulated time in" in shown
    assert "\x1b" not in shown


@pytest.mark.slow
def test_the_same_twice(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    def without_took(found: Any) -> Any:
        return [{k: v for k, v in story.items() if k != "took"} for story in found["stories"]]

    runs = [json.loads(told([project.root, "visitor", "--format", "json"], 0, capsys)) for _ in range(2)]
    assert without_took(runs[0]) == without_took(runs[1])


def test_json_says_what_was_expected_and_what_was(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = story("  - expect: {state: open, within: 1s}\n")
    found = json.loads(told([str(folder), "knocking", "--format", "json", "--coverage"], 1, capsys))
    [failed] = found["stories"]
    assert found["failed"] == 1
    assert failed["passed"] is False
    assert failed["failure"]["line"] == 4
    assert failed["failure"]["was"] == "the active states are `closed`, `closed.wait`"
    assert found["coverage"]["states"] == {"covered": 2, "of": 6}
    assert {"file", "line", "column", "message"} == set(found["coverage"]["gaps"][0])


def test_junit_is_what_continuous_integration_reads(
    story: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = story("  - expect: {said_exactly: \"a \\u0001 < b & 'c'\", within: 1s}\n")
    file = tmp_path / "report.xml"
    told([str(folder), "knocking", "shy", "--format", "junit", "-o", str(file)], 1, capsys)
    root = ET.fromstring(file.read_text("utf-8"))
    [suite] = root.findall("testsuite")
    assert root.tag == "testsuites"
    assert suite.get("tests") == root.get("tests") == "2"
    assert suite.get("failures") == root.get("failures") == "1"
    assert [case.get("name") for case in suite.findall("testcase")] == ["knocking", "shy"]
    failure = suite.find("testcase/failure")
    assert failure is not None
    assert "a \ufffd < b & 'c'" in failure.get("message", "")
    assert "behaviors/stories/knocking.yaml:4:5" in (failure.text or "")
    assert all(float(case.get("time", "")) >= 0 for case in suite.findall("testcase"))


def test_coverage_names_what_no_story_did(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = story("  - event: {name: knock, data: {who: Ani}}\n  - expect: {state: open}\n")
    shown = told([str(folder), "knocking", "--coverage"], 0, capsys)
    assert "behaviors/door.yaml:9:11: `closed` on `knock`, as event.data.who == 'nobody' is never taken" in shown
    assert "state `spinning` is never entered" in shown
    assert "`open` after 20 s, to `closed` is never taken" in shown
    assert "Covered: 3 of 6 states and 1 of 7 transitions: 14 %" in shown
    assert "less than the required 50 %" in told([str(folder), "knocking", "--fail-under", "50"], 1, capsys)


@for_each(
    ("arguments", "words"),
    [
        (["vistor"], "no project or story `vistor`: did you mean `visitor`?"),
        (["--fail-under", "101"], "--fail-under must be a number from 0 to 100"),
        (["--bound", "0", "--explore"], "--bound must be at least 1"),
        (["--home", "idle"], "--behavior and --home need --explore"),
        (["--explore", "--behavior", "tuor"], "no behaviour `tuor`: did you mean `tour`?"),
        (["--explore", "--home", "idel"], "no state `idel` in `tour`: did you mean `idle`?"),
        (["shy", "-o", "/no/such/folder/x.txt"], "can't write /no/such/folder/x.txt"),
    ],
)
def test_what_can_not_be_is_one_line(
    project: Project, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(["test", project.root, *arguments]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_a_project_without_stories_says_how_to_begin(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for file in matching(copy, "behaviors/stories/*.yaml", "behaviors/sayings/*.yaml"):
        file.unlink()
    for file in matching(copy, "functions/*.yaml"):
        file.write_text(file.read_text("utf-8").partition("examples:")[0], "utf-8")
    main_file = copy / "lumen.yaml"
    main_file.write_text(main_file.read_text("utf-8").replace("story: visitor", "# no story:"), "utf-8")
    assert main(["test", str(copy)]) == 2
    assert "docs/stories.md" in capsys.readouterr().err


@pytest.mark.process
def test_only_the_recording_robot_plays_what_it_is_told_to_fail_in(
    copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(copy), "--robot", "simulation", "--story", "voiceless"]) == 2
    error = capsys.readouterr().err
    assert "play it with --robot recording" in error
    assert error.count("\n") == 1
