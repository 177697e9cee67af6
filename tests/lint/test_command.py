"""`lumen lint` as people and programs call it."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.cli.render.text import render
from lumen.language.diagnostics import Diagnostic, Place, Severity
from lumen.rules.codes import CODES

BASE = Path(__file__).parent / "base"
ENGINE = Path(__file__).parents[2] / "engine"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    shutil.copytree(BASE, tmp_path / "project")
    return tmp_path / "project"


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_a_sound_project(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(project)]) == 0
    assert capsys.readouterr().out == "nothing wrong in 10 files\n"


def test_the_shipped_project_has_no_findings() -> None:
    assert main(["lint", str(ENGINE.parent), "--strict"]) == 0


def test_an_error_with_its_excerpt(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "behaviors/tour.yaml", "onError: idle", "onError: idel")
    assert main(["lint", str(project)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "behaviors/tour.yaml:28:14 error[unknown-state] there is no state `idel` to go to from `greet`",
        " 28 |     onError: idel",
        "    |              ^^^^",
        "    = did you mean `idle`?",
        "  behaviors/tour.yaml:14:3 `idle` stands here",
        "",
        "1 error in 10 files",
    ]


def test_a_warning_counts_with_strict_only(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "behaviors/tour.yaml", ', id: "Halo"', "")
    assert main(["lint", str(project)]) == 0
    assert main(["lint", str(project), "--strict"]) == 1
    assert "warning[missing-language]" in capsys.readouterr().out


def test_json(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    assert main(["lint", str(project), "--format", "json"]) == 1
    assert json.loads(capsys.readouterr().out) == {
        "diagnostics": [
            {
                "file": "lumen.yaml", "line": 3, "column": 8, "end_line": 3, "end_column": 12, "code": "unknown-story",
                "severity": "error", "message": "there is no story `helo`", "hint": "did you mean `hello`?",
                "related": [],
            }
        ],
        "files": 10,
    }  # fmt: skip


def test_a_folder_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(tmp_path / "nothing")]) == 2
    assert "does not exist" in capsys.readouterr().err


def test_an_empty_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(tmp_path)]) == 1
    assert "lumen.yaml:1:1 error[missing-file]" in capsys.readouterr().out


def test_every_error_at_once_and_no_traceback(project: Path) -> None:
    (project / "motions/wave.yaml").write_bytes(b"\xff\xfe")
    edit(project / "lumen.yaml", "behavior:", "behaviour:")
    edit(project / "behaviors/tour.yaml", "    do:", "\tdo:")
    done = run("-m", "lumen", "lint", str(project))
    assert done.returncode == 1
    assert not done.stderr
    assert re.findall(r"error\[([a-z0-9-]+)\]", done.stdout) == ["tab", "unknown-key", "not-utf8"]


def test_lint_imports_nothing_heavy(project: Path) -> None:
    code = (
        "import sys; from lumen.cli.main import main; main(['lint', sys.argv[1]]);"
        "heavy = {'mujoco', 'dm_control', 'pika', 'numpy', 'PIL', 'nicegui', 'matplotlib'} & set(sys.modules);"
        "sys.exit(f'imported {heavy}' if heavy else 0)"
    )
    assert run("-c", code, str(project)).returncode == 0


def test_wide_and_hostile_characters() -> None:
    text = "say: 漢字 \x1b[31m oops\n"
    finding = Diagnostic("wrong-type", "bad \x1b]0;x\x07", Place("a.yaml", 1, 15, 1, 19), "", Severity.WARNING)
    shown = render([finding], {"a.yaml": text.encode()}, coloured=False)
    assert "\x1b" not in shown
    assert "\x07" not in shown
    assert "   | " + " " * 16 + "^^^^" in shown.splitlines()


def test_every_code_that_is_used_is_registered() -> None:
    call = re.compile(
        r'(?<!draft\.)(?<!found\.)(?:report|find|say|at_word|Diagnostic|Finding|Complaint)\(\s*(?:[\w.]+,\s*)?"([a-z]+(?:-[a-z]+)*)",'
    )
    sources = [
        f for room in ("loading", "rules", "interpreters/expressions") for f in (ENGINE / "lumen" / room).rglob("*.py")
    ]
    used = {code for file in sources for code in call.findall(file.read_text())}
    assert len(used) > 60
    assert used <= CODES.keys()
    assert all(code.summary and not code.summary.endswith(".") for code in CODES.values())


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {"PYTHONPATH": str(ENGINE), "PATH": "/usr/bin:/bin"}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, env=environment, timeout=60, check=False
    )
