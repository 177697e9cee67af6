"""Another body than lumen.yaml's, and the motions of one robot alone."""

import json
import sys
from pathlib import Path
from subprocess import CompletedProcess

import pytest

import lumen
from lumen.project.chosen_model import MODEL_VARIABLE
from lumen.project.files import belongs, fingerprint, read_files
from tests.guarded import run_guarded
from tests.waiting import HANG

MAIN = "behavior: hello\nlanguages: [en]\nrobot: {name: One, model: one}\nhall: hall.xml\n"
HELLO = "id: hello\ninitial: here\nstates:\n  here: {entry: {play: nod}}\n"
BODY = """\
joints: {%s: {range: [-1, 1]}}
parts: {head: [%s]}
postures: {Stand: {%s: 0}}
roles: {head: {yaw: %s}}
"""
MJCF = '<mujoco><worldbody><body><joint name="%s"/></body></worldbody></mujoco>\n'
SHARED = "keyframes:\n  - {at: 1s, roles: {head.yaw: 0.5}}\n"
OWN = "keyframes:\n  - {at: 3s, joints: {Two: 0.2}}\n"


@pytest.fixture
def both(tmp_path: Path) -> Path:
    files = {"lumen.yaml": MAIN, "behaviors/hello.yaml": HELLO, "motions/nod.yaml": SHARED, "motions/two/nod.yaml": OWN}
    for name in ("one", "two"):
        joint = name.capitalize()
        files |= {f"models/{name}.yaml": BODY.replace("%s", joint), f"models/{name}.xml": MJCF % joint}
    for file, text in files.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(text, "utf-8")
    return tmp_path


def test_what_lies_in_another_robot_s_folder_is_not_loaded(both: Path) -> None:
    project = lumen.load(both)
    assert project.motions["nod"].tracks.keys() == {"One"}


def test_another_body_has_its_own_motions_first(both: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = fingerprint(read_files(both))
    monkeypatch.setenv(MODEL_VARIABLE, "two")
    project = lumen.load(both)
    assert project.body.name == "two"
    assert project.motions["nod"].duration >= 3.0
    assert project.motions["nod"].tracks.keys() == {"Two"}
    assert fingerprint(read_files(both)) != before


def test_a_fault_in_it_is_reported_there(both: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (both / "motions/two/nod.yaml").write_text(OWN.replace("Two", "Tow"), "utf-8")
    assert not [d for d in lumen.check(both) if d.code == "unknown-joint"]
    monkeypatch.setenv(MODEL_VARIABLE, "two")
    (found,) = (d for d in lumen.check(both) if d.code == "unknown-joint")
    assert str(found.place) == "motions/two/nod.yaml:2:23"


def test_a_folder_of_no_robot_is_told(both: Path) -> None:
    (both / "motions/two").rename(both / "motions/tow")
    (found,) = (d for d in lumen.check(both) if d.code == "not-read")
    assert found.place.file == "motions/tow/nod.yaml"
    assert "did you mean `two`?" in found.hint


def test_such_files_count() -> None:
    assert belongs("motions/two/nod.yaml")
    assert not belongs("motions/two/three/nod.yaml")
    assert not belongs("fuzzy/two/nod.yaml")


def lumen_says(*arguments: str) -> "CompletedProcess[str]":
    return run_guarded([sys.executable, "-m", "lumen", *arguments], timeout=HANG, text=True, capture_output=True)


def test_the_command_line_takes_another_body(both: Path) -> None:
    assert json.loads(lumen_says("lint", str(both), "--model", "two", "--format", "json").stdout) is not None
    done = lumen_says("lint", str(both), "--model", "twoo")
    assert done.returncode == 2
    assert "did you mean `two`?" in done.stderr


def test_a_project_begins_with_another_robot(tmp_path: Path) -> None:
    done = lumen_says("new", str(tmp_path / "mine"), "--like", "minimal", "--robot", "gretter")
    assert (done.returncode, "did you mean `greeter`?" in done.stderr) == (2, True)
    assert lumen_says("new", str(tmp_path / "mine"), "--like", "minimal", "--robot", "greeter").returncode == 0
    project = lumen.load(tmp_path / "mine")
    assert (project.robot, project.body.mjcf) == ("Greeter", "greeter.xml")
