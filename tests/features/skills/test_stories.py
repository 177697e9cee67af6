"""A skill in stories: it lasts its time, ends as the story wants, and a replay needs no code."""

import json
from pathlib import Path

import pytest

from lumen.cli.main import main
from tests.features.skills.changing import CODE, found, project_in
from tests.tables import for_each

STORY = "behaviors/stories/visitor.yaml"
RECORDED = ("--robot", "recording", "--speed", "max")


def failure_of(root: Path, steps: str) -> str:
    """Return why a story with these steps fails; empty if it passes."""
    (root / STORY).write_text(f"steps: {steps}\n", "utf-8")
    assert found(root) == []
    report = root / "report.json"
    main(["test", str(root), "--format", "json", "-o", str(report)])
    (row,) = json.loads(report.read_text("utf-8"))["stories"]
    failure = row.get("failure", {})
    return f"{failure.get('expected', '')}: {failure.get('was', '')}" if failure else ""


@for_each(
    ("steps", "failure"),
    [
        ("[{visitor: arrives}, {expect: {state: sprayed, context: {litres: 0.1}}}]", ""),
        ("[{skills: {spray: {litres: 0.5}}}, {visitor: arrives}, {expect: {context: {litres: 0.5}}}]", ""),
        (
            "[{skills: {spray: fails}}, {visitor: arrives}, {expect: {state: sprayed, within: 5s}}]",
            "state `sprayed`",
        ),
        ("[{skills: {spray: hangs}}, {visitor: arrives}, {expect: {state: sprayed, within: 5s}}]", "state `sprayed`"),
        (
            "[{skills: {spray: hangs}}, {skills: {spray: {}}}, {visitor: arrives}, {expect: {state: sprayed}}]",
            "",
        ),
        ("[{visitor: arrives}, {expect: {state: sprayed, within: 2s}}]", "state `sprayed`"),
    ],
)
def test_a_story_says_how_a_skill_ends_and_its_code_is_not_run(tmp_path: Path, steps: str, failure: str) -> None:
    root = project_in(tmp_path, {CODE: ("    print", "    raise SystemExit\n    print")})
    assert failure_of(root, steps)[: len(failure)] == failure if failure else failure_of(root, steps) == ""


@for_each(
    ("step", "finding"),
    [
        ("{skills: {spry: {}}}", "unknown-key | `spry` is not a key of `skills` | did you mean `spray`?"),
        ("{skills: {spray: {liters: 1}}}", "unknown-key | `liters` is not a key of `spray` | did you mean `litres`?"),
        ("{skills: {spray: {litres: much}}}", "wrong-type | `litres` should be a number, not a text"),
        ("{skills: {spray: fail}}", "wrong-value | `spray` can't be `fail`"),
        ("{expect: {did: spry}}", "wrong-value | `did` can't be `spry` | did you mean `spray`?"),
    ],
)
def test_lint_checks_what_a_story_says_of_a_skill(tmp_path: Path, step: str, finding: str) -> None:
    root = project_in(tmp_path)
    (root / STORY).write_text(f"steps: [{step}]\n", "utf-8")
    (one,) = found(root)
    assert finding in one


@pytest.mark.process
def test_a_run_is_replayed_and_explained_without_the_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = project_in(tmp_path)
    assert main(["run", str(root), "--story", "visitor", *RECORDED]) == 0
    lines = [line.split(maxsplit=2) for line in capsys.readouterr().out.splitlines() if line[:3] == " 0:"]
    assert ["0:00.2", "robot", "does spray with duration 3s, nozzle left"] in lines
    assert ["0:03.2", "state", "sprayed  (done)"] in lines
    (root / CODE).unlink()
    assert main(["replay", "--project", str(root)]) == 0
    assert "1 the same" in capsys.readouterr().out
    assert main(["story", "--project", str(root), "-o", str(tmp_path / "visit.yaml")]) == 0
    assert "robot: {spray: {result: {litres: 0.1}}}" in (tmp_path / "visit.yaml").read_text("utf-8")


@pytest.mark.process
def test_real_skills_run_in_the_time_of_the_story(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = project_in(tmp_path, {STORY: ("context: {litres: 0.1}", "context: {litres: 0.2}")})
    assert main(["test", str(root), "--real-skills", "--verbose"]) == 0
    lines = [line.split(maxsplit=2) for line in capsys.readouterr().out.splitlines() if ":" in line[:8]]
    assert ["0:00.2", "robot", "does spray with duration 3s, nozzle left"] in lines
    assert ["0:00.2", "spray", "spraying with the left nozzle"] in lines
    assert ["0:03.2", "state", "sprayed  (done)"] in lines
    assert main(["test", str(root)]) == 1


def test_coverage_counts_the_skills_that_stories_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    unused = "performed-by: {python: skills/spray.py}\n"
    root = project_in(tmp_path, {"skills/mist.yaml": ("", unused)})
    assert main(["test", str(root), "--coverage", "--fail-under", "51"]) == 1
    shown = capsys.readouterr().out
    assert "skills/mist.yaml:1:1: skill `mist` is never used" in shown
    assert "transitions and 1 of 2 skills: 50 %, less than the required 51 %" in shown
    (root / STORY).write_text("steps: [{wait: 1s}]\n", "utf-8")
    main(["test", str(root), "--coverage", "--format", "json"])
    coverage = json.loads(capsys.readouterr().out)["coverage"]
    assert coverage["skills"] == {"covered": 0, "of": 2}


@pytest.mark.slow
@pytest.mark.physics
def test_the_simulated_robot_ends_a_skill_as_the_story_says(tmp_path: Path) -> None:
    root = project_in(tmp_path, {CODE: ("    print", "    raise SystemExit\n    print")})
    steps = "[{skills: {spray: {litres: 0.5}}}, {visitor: arrives}, {expect: {context: {litres: 0.5}}}]"
    (root / STORY).write_text(f"steps: {steps}\n", "utf-8")
    assert main(["run", str(root), "--story", "visitor", "--robot", "simulation", "--speed", "max"]) == 0
