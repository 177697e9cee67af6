"""`lumen new KIND NAME`: what it writes can be linted and used at once, and it overwrites nothing."""

import json
import shutil
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.lint import check_files
from lumen.project import load
from lumen.project.files import read_files
from lumen.run.templates import TEMPLATES
from tests import ROOT
from tests.tables import for_each


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = tmp_path / "hall"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    monkeypatch.chdir(root)
    return root


def test_a_function_is_tried_at_once(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "function", "day_part"]) == 0
    assert capsys.readouterr().out.startswith("wrote functions/day_part.yaml. Next:\n")
    behavior = root / "behaviors/hello.yaml"
    behavior.write_text(behavior.read_text().replace("Hello! I am Nao.", "Good {{ day_part(hour()) }}! I am Nao."))
    assert check_files(root, read_files(root))[1] == ()
    assert main(["test"]) == 0
    assert "functions: 2 of 2 examples" in capsys.readouterr().out


@for_each(
    ("before", "after"),
    [
        ("", "modules:\n  mood: {command: [python3, mood.py], here: true, health: 5s}\n"),
        ("modules:\n    memory: {here: false}\n", "modules:\n    mood: {command"),
        ("modules: {memory: {here: false}}   # one\n", "modules: {mood: {command"),
        ("modules: {}\n", "modules: {mood: {command"),
        ("modules:  # none yet\n  # none\n", "modules:  # none yet\n  mood: {command"),
    ],
)
def test_a_module_gets_its_entry(tmp_path: Path, before: str, after: str) -> None:
    root = tmp_path / f"hall{abs(hash(before))}"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    with (root / "lumen.yaml").open("a") as file:
        file.write(before)
    text = (root / "lumen.yaml").read_text()
    assert main(["new", "module", "mood", "--project", str(root)]) == 0
    written = (root / "lumen.yaml").read_text()
    assert after in written
    assert all(line in written for line in text.splitlines() if not line.startswith("modules: {"))
    project = load(root)
    assert project.modules["mood"].command == ("python3", "mood.py")
    assert "memory" not in before or "memory" in project.modules
    assert check_files(root, read_files(root))[1] == ()


def test_a_robot_is_written(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "robot", "paper_printer", "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == ["drivers/paper_printer.py"]
    assert "class PaperPrinter:" in (root / "drivers/paper_printer.py").read_text()


@for_each(
    ("words", "says"),
    [
        (["fuction", "x"], "can't add a `fuction` to a project: did you mean `function`?"),
        (["function", "one-two"], "a function can't be called `one-two`: write letters, digits and `_`"),
        (["function", "size"], "the function `size` comes with Lumen: choose another name"),
        (["module", "eyes"], "the module `eyes` comes with Lumen: choose another name"),
        (["robot", "3d"], "a robot can't be called `3d`"),
    ],
)
def test_a_name_that_can_not_be_is_a_sentence(
    root: Path, capsys: pytest.CaptureFixture[str], words: list[str], says: str
) -> None:
    before = read_files(root)
    assert main(["new", *words]) == 2
    assert says in capsys.readouterr().err
    assert read_files(root) == before


@pytest.mark.parametrize("kind", TEMPLATES)
def test_nothing_is_overwritten(root: Path, capsys: pytest.CaptureFixture[str], kind: str) -> None:
    assert main(["new", kind, "mine"]) == 0
    before = {path: path.read_bytes() for path in root.rglob("*") if path.is_file()}
    assert main(["new", kind, "mine"]) == 2
    assert "already" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in root.rglob("*") if path.is_file()} == before


def test_outside_of_a_project(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "function", "x"]) == 2
    assert "there is no lumen.yaml" in capsys.readouterr().err
