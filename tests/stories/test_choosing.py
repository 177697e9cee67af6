"""The stories that a word selects: by a name, a pattern or a file; a file elsewhere selects none."""

from pathlib import Path

import pytest

from lumen.cli.main import main

SHY = Path("behaviors", "stories", "shy.yaml")


def names(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> list[str]:
    assert main(["test", *arguments]) == 0
    lines = capsys.readouterr().out.splitlines()
    return [line.split()[2].rstrip(":") for line in lines if line.startswith("ok ")]


@pytest.mark.parametrize("words", [["shy"], ["shy.yaml"], [str(SHY)], ["shy", "s[h]y", "shy.yaml"]])
def test_one_story_in_many_ways(copy: Path, words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert names([str(copy), *words], capsys) == ["shy"]


def test_a_name_with_the_signs_of_a_pattern_is_that_name(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (copy / "behaviors" / "stories" / "shy [two].yaml").write_text("steps: [{wait: 1s}]\n", "utf-8")
    assert main(["test", str(copy), "shy [two]"]) == 0
    assert "1 story" in capsys.readouterr().out


@pytest.mark.slow
def test_a_pattern_means_all_that_fit(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert names([str(copy), "safety_b*", "shy"], capsys) == [
        "safety_battery", "safety_brain", "safety_broken_posture", "safety_broken_wake", "shy",
    ]  # fmt: skip


def test_a_file_says_which_project_it_is_of(
    copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "behaviors" / "stories" / "only_here.yaml").write_text("steps: [{wait: 1s}]\n", "utf-8")
    monkeypatch.chdir(tmp_path.parent)
    assert names([str(copy / "behaviors" / "stories" / "only_here.yaml")], capsys) == ["only_here"]


@pytest.mark.parametrize("command", [["test"], pytest.param(["run", "--story"], marks=pytest.mark.process)])
def test_a_file_elsewhere_is_not_the_story_of_that_name(
    copy: Path, tmp_path: Path, command: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(copy)
    elsewhere = tmp_path / "shy.yaml"
    elsewhere.write_text("steps: [{wait: 1s}]\n", "utf-8")
    assert main([*command, str(elsewhere)]) == 2
    assert "move it there" in capsys.readouterr().err
    assert main([*command, "no/such/shi.yaml"]) == 2
    assert "no story `no/such/shi.yaml`: did you mean `shy`?" in capsys.readouterr().err


@pytest.mark.process
def test_one_story_at_a_time_is_run(
    copy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(copy)
    assert main(["run", "--story", "safety_*"]) == 2
    assert "choose one story" in capsys.readouterr().err


def test_the_first_that_fails_is_the_last(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("aa", "ab"):
        story = copy / "behaviors" / "stories" / f"{name}.yaml"
        story.write_text("steps: [{expect: {state: sing, within: 1s}}]\n", "utf-8")
    assert main(["test", str(copy), "-x"]) == 1
    shown = capsys.readouterr().out
    assert "1 story, 1 failed" in shown
    assert "aa" in shown
