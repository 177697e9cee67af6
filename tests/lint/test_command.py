"""`lumen lint` as people and programs call it."""

import json
import re
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.lint.codes import codes, families
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import CompletedProcess, run_guarded
from tests.tour.conftest import copy
from tests.waiting import HANG

__all__ = ["copy"]

BASE = Path(__file__).parent / "base"
ENGINE = ROOT / "engine"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    copied_project(BASE, tmp_path / "project")
    return tmp_path / "project"


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_a_sound_project(project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parent)  # from where its path is shortest in full
    assert main(["lint", str(project)]) == 0
    assert capsys.readouterr().out == f"nothing wrong; 10 files checked in {project}\n"


def test_the_shipped_project_has_no_findings() -> None:
    assert main(["lint", str(ENGINE.parent), "--strict"]) == 0


def test_an_error_with_its_excerpt(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(__file__).parent)  # from where its path is shortest in full
    edit(project / "behaviors/tour.yaml", "onError: idle", "onError: idel")
    assert main(["lint", str(project)]) == 1
    shown = capsys.readouterr().out.splitlines()
    assert shown[:4] == [
        f"{project}/behaviors/tour.yaml:28:14 error[unknown-state] there is no state `idel` to go to from `greet`",
        " 28 |     onError: idel",
        "    |              ^^^^",
        "    = did you mean `idle`?",
    ]
    assert shown[-2:] == [
        f"1 error in 1 file; 10 files checked in {project}",
        "For more: `lumen explain unknown-state`",
    ]


def test_the_page_about_lint_shows_what_it_prints(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    tour = copy / "behaviors/tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace("onError: watching", "onError: wathing", 1), "utf-8")
    monkeypatch.chdir(copy)
    assert main(["lint"]) == 1
    printed = re.sub(r"\d+ files checked", "… files checked", capsys.readouterr().out)
    page = re.sub(r"\d+ files checked", "… files checked", (ENGINE.parent / "docs/lint.md").read_text("utf-8"))
    assert f"```console\n$ lumen lint\n{printed}```" in page


def test_every_option_stands_on_the_page_about_lint(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["lint", "--help"])
    page = (ENGINE.parent / "docs/lint.md").read_text()
    assert all(option in page for option in re.findall(r"--[a-z-]+", capsys.readouterr().out) if option != "--help")


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


@pytest.mark.slow
def test_every_error_at_once_and_no_traceback(project: Path) -> None:
    (project / "motions/wave.yaml").write_bytes(b"\xff\xfe")
    edit(project / "lumen.yaml", "behavior:", "behaviour:")
    edit(project / "behaviors/tour.yaml", "    do:", "\tdo:")
    done = run("-m", "lumen", "lint", str(project))
    assert done.returncode == 1
    assert not done.stderr
    assert re.findall(r"error\[([a-z0-9-]+)\]", done.stdout) == ["tab", "unknown-key", "not-utf8"]


def test_files_are_named_from_where_one_stands(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    monkeypatch.chdir(project)
    assert main(["lint"]) == 1
    assert capsys.readouterr().out.startswith("lumen.yaml:3:8 ")
    monkeypatch.chdir(project / "motions")
    assert main(["lint", "--format", "concise"]) == 1
    assert capsys.readouterr().out.startswith("../lumen.yaml:3:8: error[unknown-story] ")
    monkeypatch.chdir(project.parent)
    assert main(["lint", "project"]) == 1
    assert capsys.readouterr().out.startswith("project/lumen.yaml:3:8 ")


def test_files_of_a_project_show_their_own_findings(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    edit(project / "behaviors/tour.yaml", "onError: idle", "onError: idel")
    assert main(["lint", str(project / "motions/wave.yaml"), str(project / "fuzzy")]) == 0
    assert capsys.readouterr().out.startswith("nothing wrong; 10 files checked")
    assert main(["lint", str(project / "behaviors/tour.yaml"), "--format", "json"]) == 1
    assert [d["file"] for d in json.loads(capsys.readouterr().out)["diagnostics"]] == ["behaviors/tour.yaml"]
    assert main(["lint", str(project / "behaviors/tour.yaml"), str(project / "lumen.yaml"), "--format", "json"]) == 1
    assert len(json.loads(capsys.readouterr().out)["diagnostics"]) == 2


def test_several_projects(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    copied_project(BASE, tmp_path / "other")
    assert main(["lint", str(project), str(tmp_path / "other"), "--format", "concise"]) == 1
    assert capsys.readouterr().out.endswith("1 error in 1 file; 20 files checked in 2 projects\n")


def test_what_is_typed_stands_in_place_of_the_file(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    name = project / "behaviors/tour.yaml"
    typed = name.read_bytes().replace(b"onError: idle", b"onError: idel")
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(typed)))
    assert main(["lint", "-", "--stdin-filename", str(name), "--format", "concise"]) == 1
    assert "unknown-state" in capsys.readouterr().out


def test_what_is_typed_without_end_is_a_line(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(b"#" * 5_000_000)))
    assert main(["lint", "-", "--stdin-filename", str(project / "behaviors/tour.yaml")]) == 2
    assert (
        capsys.readouterr().err == "lumen lint: standard input is larger than 4 MB, the limit for a file of a project\n"
    )


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--select", "speling"], "there is no code `speling`"),
        (["--select", ""], "a code is missing"),
        (["--ignore", "unkown-state"], "did you mean `unknown-state`?"),
        (["/dev/null/x"], "does not exist"),
        (["-"], "--stdin-filename"),
        (["--stdin-filename", "x.yaml"], "write `lumen lint -"),
        (["--fix", "--diff"], "choose one"),
        (["--watch", "--fix"], "--watch"),
        (["--watch", "--format", "json"], "for people"),
        (["FOREIGN"], "belongs to no project"),
        (["PROJECT/README"], "has no file that lint reads"),
        (["-", "--stdin-filename", "PROJECT/README"], "is not a file that lint reads"),
        (["-", "--stdin-filename", "FOREIGN"], "belongs to no project"),
    ],
)
def test_bad_usage_is_a_line_and_2(
    arguments: list[str], part: str, project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "x.yaml").write_text("")
    (project / "README").write_text("")
    named = [a.replace("PROJECT", str(project)).replace("FOREIGN", str(tmp_path / "x.yaml")) for a in arguments]
    assert main(["lint", *named]) == 2
    error = capsys.readouterr().err
    assert part in error
    assert error.count("\n") == 1


def test_select_and_ignore(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    edit(project / "behaviors/tour.yaml", ', id: "Halo"', "")
    for options, found in {
        (): ["missing-language", "unknown-story"],
        ("--select", "speech"): ["missing-language"],
        ("--select", "unknown,shape"): ["unknown-story"],
        ("--ignore", "unknown-story", "--ignore", "tab"): ["missing-language"],
        ("--select", "references", "--ignore", "unknown-story"): [],
    }.items():
        counts = "unknown-story" in found
        assert main(["lint", str(project), "--format", "json", *options]) == counts
        assert [d["code"] for d in json.loads(capsys.readouterr().out)["diagnostics"]] == found


@pytest.mark.slow
def test_the_verdict_counts_though_nobody_reads_it(project: Path) -> None:
    edit(project / "lumen.yaml", "story: hello", "story: helo")
    command = f"set -o pipefail; {sys.executable} -m lumen lint {project} | true"
    environment = {"PYTHONPATH": str(ENGINE), "PATH": "/usr/bin:/bin"}
    done = run_guarded(
        ["bash", "-c", command], capture_output=True, text=True, env=environment, timeout=HANG, check=False
    )
    assert (done.returncode, done.stderr) == (1, "")


@pytest.mark.slow
def test_where_nothing_can_be_printed_that_is_said(project: Path) -> None:
    command = f"{sys.executable} -m lumen lint {project} > /dev/full"
    environment = {"PYTHONPATH": str(ENGINE), "PATH": "/usr/bin:/bin"}
    done = run_guarded(["bash", "-c", command], capture_output=True, text=True, env=environment, timeout=HANG)
    assert (done.returncode, done.stderr) == (2, "lumen lint: can't print: no space left on device\n")


def test_explain(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "unknown-state"]) == 0
    shown = capsys.readouterr().out
    assert "unknown-state  error, references" in shown
    assert "   3 |     on: {touched: gret}\n     |                   ^^^^\n" in shown
    assert main(["explain"]) == 0
    assert all(f"  {code} " in line for code, line in zip(codes(), rows(capsys.readouterr().out), strict=True))
    assert main(["explain", "unkown-state"]) == 2
    assert capsys.readouterr().err == "lumen explain: there is no code `unkown-state`: did you mean `unknown-state`?\n"


def rows(shown: str) -> list[str]:
    return [line for line in shown.splitlines() if line.startswith("  ")]


def test_explain_lists_what_a_word_stands_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "speech"]) == 0
    assert [row.split()[0] for row in rows(capsys.readouterr().out)] == list(families()["speech"])
    assert main(["explain", "[unknown]"]) == 0
    assert all(row.startswith("  unknown-") for row in rows(capsys.readouterr().out))


def test_explain_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "tab", "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["code"], found["family"], found["severity"]) == ("tab", "text", "error")
    assert found["wrong"][0]["mark"] == {"line": 3, "first": 1, "last": 2}
    assert main(["explain", "--format", "json"]) == 0
    assert [entry["code"] for entry in json.loads(capsys.readouterr().out)["codes"]] == list(codes())


@pytest.mark.slow
def test_lint_imports_nothing_heavy(project: Path) -> None:
    code = (
        "import sys; from lumen.cli.main import main; main(['lint', sys.argv[1]]);"
        "heavy = {'mujoco', 'dm_control', 'pika', 'numpy', 'PIL', 'nicegui', 'matplotlib'} & set(sys.modules);"
        "heavy |= {'lumen.lint.pages', 'lumen.lint.fixes', 'watchfiles', 'pygls'} & set(sys.modules);"
        "heavy |= {'lumen.statechart.stepping', 'jsonschema', 'shutil'} & set(sys.modules);"
        "sys.exit(f'imported {heavy}' if heavy else 0)"
    )
    assert run("-c", code, str(project)).returncode == 0


def run(*arguments: str) -> CompletedProcess[str]:
    environment = {"PYTHONPATH": str(ENGINE), "PATH": "/usr/bin:/bin"}
    return run_guarded(
        [sys.executable, *arguments], capture_output=True, text=True, env=environment, timeout=HANG, check=False
    )
