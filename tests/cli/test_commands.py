"""The smaller verbs: new, graph, play."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

import lumen
from lumen.cli.main import main
from tests import ROOT
from tests.scanning import matching


@pytest.mark.process
@pytest.mark.slow
def test_a_new_project_is_whole_and_clean(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "mine"
    assert main(["new", str(folder)]) == 0
    assert "lumen lint" in capsys.readouterr().out
    assert lumen.check(folder) == []
    assert main(["run", str(folder), "--robot", "recording", "--speed", "max", "--story", "silence"]) == 0


@pytest.mark.slow
@pytest.mark.parametrize(("words", "story"), [(["--minimal"], "visitor"), (["--like", "museum"], "visit")])
def test_a_project_like_another_is_whole_and_clean(
    words: list[str], story: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "mine"
    assert main(["new", str(folder), *words, "--action", "me/lumen@0123"]) == 0
    assert f"lumen run --story {story} " in capsys.readouterr().out
    assert lumen.check(folder) == []
    assert main(["test", str(folder), story]) == 0
    for file in matching(folder, "**/*.yaml"):
        schema = file.read_text("utf-8").partition("$schema=")[2].partition("\n")[0]
        assert (file.parent / schema).is_file()
    workflow = yaml.safe_load((folder / ".github/workflows/exhibition.yml").read_text("utf-8"))
    steps = workflow["jobs"]["check"]["steps"]
    assert [step.get("uses", step.get("run")) for step in steps][1:] == ["me/lumen@0123", "lumen test"]
    assert set(steps[1]["with"]) <= set(yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))["inputs"])
    assert ".lumen/" in (folder / ".gitignore").read_text("utf-8").splitlines()
    assert f"lumen run --story {story} " in (folder / "README.md").read_text("utf-8")


def test_rows_of_routes_that_lumen_new_wrote_are_never_unused(tmp_path: Path) -> None:
    """The remaining behaviour handles none of their events."""
    folder = tmp_path / "mine"
    assert main(["new", str(folder)]) == 0
    shutil.rmtree(folder / "behaviors")
    shutil.rmtree(folder / "functions")
    (folder / "behaviors").mkdir()
    (folder / "behaviors" / "tour.yaml").write_text("states: {idle: {on: {fallen: idle}}}\n", "utf-8")
    main_file = folder / "lumen.yaml"
    main_file.write_text(main_file.read_text("utf-8").replace("\nstory: ", "\n# "), "utf-8")
    assert lumen.check(folder) == []


def test_the_minimal_project_is_short() -> None:
    files = matching(ROOT / "examples/minimal", "**/*.yaml")
    assert sum(len(file.read_text("utf-8").splitlines()) for file in files) <= 55


def test_nothing_is_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "theirs.txt").write_text("precious", "utf-8")
    assert main(["new", str(tmp_path)]) == 2
    assert "not empty" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["theirs.txt"]


def test_a_graph_of_the_tour(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("stateDiagram-v2")
    file = tmp_path / "tour.mmd"
    assert main(["graph", "tour", "-o", str(file)]) == 0
    assert file.read_text("utf-8") == printed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["graph", "tuor"], "did you mean `tour`?"),
        (["graph", "-o", "/no/such/folder/x.mmd"], "can't write"),
        (["play", "danse"], "did you mean `dance`?"),
        (["play", "nowhere.yaml"], "no file nowhere.yaml"),
        (["new", "/proc/new"], "can't write"),
    ],
)
def test_mistakes_are_one_line(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_a_motion_on_the_simulated_robot(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["play", "goodbye"]) == 0
    usual = capsys.readouterr().out
    assert "finished, on its feet" in usual
    assert main(["play", "goodbye", "--imperfections", "none"]) == 0
    assert "finished, on its feet" in (perfect := capsys.readouterr().out)
    assert perfect != usual


@pytest.mark.process
@pytest.mark.slow
def test_a_film_of_a_motion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "goodbye.mp4"
    short = tmp_path / "nod.yaml"
    short.write_text("keyframes:\n  - {at: 300ms, joints: {HeadPitch: 0.2}}\n", "utf-8")
    assert main(["play", str(short), "--video", str(file), "--size", "320x240"]) == 0
    assert file.stat().st_size > 1000
    assert file.read_bytes()[4:8] == b"ftyp"


def test_what_was_made_is_said_as_one_object(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def printed(*words: str) -> Any:
        assert main([*words, "--format", "json"]) == 0
        return json.loads(capsys.readouterr().out)

    folder, file = tmp_path / "exhib", tmp_path / "tour.svg"
    made = printed("new", str(folder), "--minimal")
    assert made == {"folder": str(folder), "like": "minimal", "behavior": "hello", "story": "visitor"}
    assert printed("graph", "-o", str(file), "--layout", "own") == {"behavior": "tour", "wrote": str(file)}
    assert printed("graph")["mermaid"].startswith("stateDiagram-v2")
