"""A YAML file beside lumen.yaml that an installed package adds: read, checked, hashed, completed and listed."""

import json
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.hover import hover
from lumen.lint import check_files
from lumen.project.building import draft
from lumen.project.files import belongs, fingerprint, read_files
from lumen.project.unread import unread_in
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed
from tests.tables import for_each

GUESTS = "Budi: {age: 30, host: true}\nSari: {age: 4}\n"
FAULTY = """
from lumen.feature import Feature, FileRow

FEATURE = Feature(name="faulty", files={"guests.yaml": FileRow("faulty_guests:build", "faulty_guests:SCHEMA")})
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A project with a guests.yaml."""
    root = copied_project(ROOT / "tests/lint/base", tmp_path / "project")
    (root / "guests.yaml").write_text(GUESTS)
    return root


def found(root: Path) -> list[str]:
    return [f"{each.place} {each.code} | {each.message}" for each in check_files(root, read_files(root))[1]]


@pytest.mark.process
def test_the_file_is_read_and_its_content_is_in_the_project(stranger: Path, root: Path) -> None:
    files = read_files(root)
    assert draft(files).beside == {"guests.yaml": {"Budi": 30, "Sari": 4}}
    project, diagnostics = check_files(root, files)
    assert project, diagnostics
    assert project.documents["guests.yaml"].data["Sari"] == {"age": 4}


@pytest.mark.process
def test_a_changed_file_is_another_project(stranger: Path, root: Path) -> None:
    before = read_files(root)
    (root / "guests.yaml").write_text("Sari: {age: 5}\n")
    assert belongs("guests.yaml")
    assert fingerprint(read_files(root)) != fingerprint(before)


@pytest.mark.process
@for_each(
    ("guests", "finding"),
    [
        ("Sari: {age: -4}\n", "guests.yaml:1:13 wrong-value | "),
        ("Budi: {}\nSari: {aeg: 4}\n", "guests.yaml:2:8 unknown-key | "),
        ("Budi: {host: true}\nSari: {host: true}\n", "guests.yaml:2:14 two-hosts | `Budi` in guests.yaml is the host"),
        ("Sari: {age: 4\n", "guests.yaml:1:7 yaml-syntax | "),
    ],
)
def test_lint_finds_mistakes_at_their_words(guests: str, finding: str, stranger: Path, root: Path) -> None:
    (root / "guests.yaml").write_text(guests)
    (only,) = found(root)
    assert only.startswith(finding)


def test_without_the_package_the_file_is_not_read(root: Path) -> None:
    assert "guests.yaml" not in read_files(root)


@pytest.mark.process
def test_the_editor_explains_its_keys(stranger: Path, root: Path) -> None:
    assert hover(Analysis(root, read_files(root)), "guests.yaml", 1, 8) == "`age`: How old the guest is [years]"


@pytest.mark.process
def test_lumen_schema_prints_its_schema(
    stranger: Path, root: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def assigned() -> dict[str, list[str]]:
        assert main(["schema", "--vscode"]) == 0
        return dict(json.loads(capsys.readouterr().out)["yaml.schemas"])

    monkeypatch.chdir(root)
    assert main(["schema", "guests"]) == 0
    own = capsys.readouterr().out
    assert json.loads(own)["description"] == "The visitors who are expected"
    assert main(["schema"]) == 0
    assert ["guests", "guests.yaml", "Guests"] in [line.split() for line in capsys.readouterr().out.splitlines()]
    assert not [each for each in assigned() if "guests" in each]
    (root / "schemas/guests.schema.json").write_text(own)
    assert assigned()["./schemas/guests.schema.json"] == ["guests.yaml"]
    assert list(unread_in(root, (), lambda _: None)) == []


@for_each(
    ("module", "fault"),
    [
        ("SCHEMA = {'type': 'object'}\ndef build(data, report, *, name):\n    1 / 0", "ZeroDivisionError: division by"),
        ("SCHEMA = 3\ndef build(data, report, *, name): ...", "TypeError: `faulty_guests:SCHEMA` is no JSON Schema"),
        ("import not_installed", "ModuleNotFoundError: No module named 'not_installed'"),
    ],
)
def test_a_faulty_row_is_one_finding(module: str, fault: str, installed: Installed, root: Path) -> None:
    installed.write("faulty", FAULTY, faulty_guests=module)
    (finding,) = found(root)
    assert "broken-feature | the installed package `faulty` 1.0 is faulty: reading `guests.yaml` raised" in finding
    assert fault in finding
