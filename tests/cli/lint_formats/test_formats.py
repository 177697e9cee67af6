"""Every format of `lumen lint`: the same findings in each, as the file of its name here has them."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from jsonschema import Draft4Validator

from lumen.cli.render import finding_formats, render
from lumen.language.diagnostics import Diagnostic, Place, Related, Severity
from lumen.project.files import Unreadable
from lumen.run.linting.findings import Findings
from tests.fetched import fetched
from tests.tables import for_each

HERE = Path(__file__).parent

TOUR = """states:
  idle:
    on: {touched: gret}   # lumen: ignore[unused-event] not yet
  greet:
    do: {say: "漢字 {{ context.nmae }}"}
    onDone: idle
  greet: {}
"""
FILES = {"behaviors/tour.yaml": TOUR.encode(), "lumen.yaml": b"name: 50% off, a:b\n", "motions/x.yaml": b"a: 1\n"}
BEHIND = Place("behaviors/tour.yaml", 7, 3, 7, 8)

FOUND = Findings(
    (
        Diagnostic("unknown-state", "there is no state `gret`", Place("behaviors/tour.yaml", 3, 19, 3, 23),
                   "did you mean `greet`?", related=(Related(Place("behaviors/tour.yaml", 4, 3, 4, 8), "it is here"),)),
        Diagnostic("unused-ignore", "there is no `unused-event` here to ignore",
                   Place("behaviors/tour.yaml", 3, 43, 3, 55), "delete this comment", Severity.WARNING),
        Diagnostic("unknown-context-key", "the context has no `nmae`", Place("behaviors/tour.yaml", 5, 30, 5, 34)),
        Diagnostic("duplicate-key", "`greet` is written twice in the same place", BEHIND,
                   related=(Related(Place("behaviors/tour.yaml", 4, 3, 4, 8), "first here"),)),
        Diagnostic("wrong-value", "50% off, a:b\r\nis \x1b[31m bad", Place("lumen.yaml", 1, 7, 2, 1), "",
                   Severity.INFO),
        Diagnostic("missing-file", "there is no motions/y.yaml", Place("motions/y.yaml")),
    ),
    FILES,
)  # fmt: skip


@for_each("format", finding_formats())
def test_findings_read_as_they_did(format: str) -> None:
    expected = next(HERE.glob(f"{format}.*")).read_bytes().decode()
    assert _without_pages(render(format, [FOUND])) + "\n" == expected


def _without_pages(shown: str) -> str:
    """Empty the rules of SARIF output: their text comes from the rules' pages, which may change."""
    return re.sub(r'"rules": \[\n.*?\n          \]', '"rules": []', shown, flags=re.DOTALL)


@for_each("format", finding_formats())
def test_no_findings(format: str) -> None:
    shown = render(format, [Findings((), FILES)])
    assert "error" not in re.sub(r'errors="0"|sarif-v2.1.0/errata01', "", shown)
    if format in ("text", "concise", "github"):
        assert shown == "nothing wrong; 3 files checked"


@pytest.mark.parametrize("format", ["text", "concise", "github", "junit"])
def test_nothing_in_a_file_reaches_a_terminal_as_a_command(format: str) -> None:
    hostile = Diagnostic("wrong-type", "a \x1b]0;x\x07\x9b", Place("a\x1b[2J.yaml", 1, 1, 1, 5), "\x08")
    shown = render(format, [Findings((hostile,), {"a\x1b[2J.yaml": b"\x1b[31mred\n"})])
    assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", shown)


def test_the_reason_why_a_file_can_not_be_read_is_not_shown_as_its_text() -> None:
    finding = Diagnostic("unreadable-file", "this can't be read: it is a folder", Place("a.yaml"))
    shown = render("text", [Findings((finding,), {"a.yaml": Unreadable(b"it is a folder")})])
    assert shown.count("it is a folder") == 1


def test_wide_characters_move_the_mark() -> None:
    finding = Diagnostic("wrong-type", "bad", Place("a.yaml", 1, 9, 1, 13), "", Severity.WARNING)
    assert "   |           ^^^^" in render("text", [Findings((finding,), {"a.yaml": "say: 漢字 oops\n".encode()})])


@pytest.mark.parametrize("column", [1, 200, 700, 996])
def test_of_a_long_line_the_part_around_the_word_is_shown(column: int) -> None:
    line = "x" * (column - 1) + "WORD" + "x" * (996 - column + 1)
    finding = Diagnostic("wrong-type", "bad", Place("a.yaml", 1, column, 1, column + 4))
    excerpt, mark = render("text", [Findings((finding,), {"a.yaml": line.encode()})]).splitlines()[1:3]
    assert len(excerpt) < 160
    assert excerpt[mark.index("^") : mark.rindex("^") + 1] == "WORD"


def test_sarif_is_what_its_schema_wants() -> None:
    schema = json.loads((fetched("sarif") / "lib/schemas/sarif-2.1.0-rtm.5.json").read_text())
    for found in ([FOUND], [], [Findings((), {})], [FOUND, Findings(FOUND.diagnostics, FILES, "/some where/ü")]):
        log = json.loads(render("sarif", found))
        assert not [error.message for error in Draft4Validator(schema).iter_errors(log)]
        assert len(log["runs"]) == len(found)


def test_sarif_names_files_from_the_project_and_the_project_from_the_repository(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    project = tmp_path / "my show"
    project.mkdir()
    (run,) = json.loads(render("sarif", [Findings(FOUND.diagnostics, FILES, str(project))]))["runs"]
    assert run["originalUriBaseIds"] == {
        "PROJECT": {"uri": "my%20show/", "uriBaseId": "SRCROOT"},
        "SRCROOT": {"uri": tmp_path.as_uri() + "/"},
    }
    place = run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
    assert place == {"uri": "behaviors/tour.yaml", "uriBaseId": "PROJECT"}


def test_github_names_files_from_the_repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GITHUB_WORKSPACE", raising=False)
    (tmp_path / ".git").mkdir()
    (tmp_path / "a,b").mkdir()
    monkeypatch.chdir(tmp_path / "a,b")
    shown = render("github", [Findings(FOUND.diagnostics, FILES, ".")])
    assert shown.startswith("::error title=unknown-state,file=a%2Cb/behaviors/tour.yaml,line=3,")


def test_junit_counts_what_it_holds() -> None:
    root = ET.fromstring(render("junit", [FOUND, Findings((), FILES)]))
    assert root.get("tests") == str(len(root.findall(".//testcase")))
    assert root.get("failures") == str(len(root.findall(".//failure"))) == "5"


def test_json_says_of_several_projects_which() -> None:
    found = json.loads(render("json", [FOUND, Findings(FOUND.diagnostics[:1], FILES, "b")]))
    assert found["files"] == 6
    assert [row["project"] for row in found["diagnostics"]] == [""] * 6 + ["b"]
    assert "project" not in json.loads(render("json", [FOUND]))["diagnostics"][0]


def test_github_is_told_to_say_what_it_leaves_out() -> None:
    one = FOUND.diagnostics[0]
    few, many = (render("github", [Findings([one] * number, FILES)]) for number in (10, 23))
    assert "::notice" not in few
    assert "::group::" not in few
    shown = "GitHub shows the first 10 of a kind: 13 errors more are only in the log of this step"
    assert f"::notice title=lumen lint::{shown}\n::group::All findings\n" in many
    listed = many.partition("::group::All findings\n")[2].partition("::endgroup::")[0].splitlines()
    assert len(listed) == 23
    assert not [line for line in listed if line.startswith("::")]
