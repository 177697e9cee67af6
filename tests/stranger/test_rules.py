"""A stranger's lint rule reports, explains and repairs like one of Lumen's; a faulty one is one finding."""

import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from scripts.rule_pages import said

from lumen.cli.main import main
from lumen.feature import rows
from lumen.lint import check_files
from lumen.lint.codes import codes, families
from lumen.lint.pages import page
from lumen.project.files import read_files
from tests import ROOT
from tests.copying import copied_project
from tests.features.editor.client import Client
from tests.stranger.installing import Installed, Lumen

BASE = ROOT / "tests/lint/pages/base"
CODE = "small-name"

FAULTY = """
from lumen.feature import Feature

FEATURE = Feature(name="faulty", rules=("faulty_rules:check", "faulty_rules:other", "faulty_rules:gone"))
"""
FAULTY_RULES = """
from lumen.language.diagnostics import WARNING, Code

LATER = Code("later", "names", WARNING, "found by a rule after a faulty one")

def check(draft):
    draft.settings.name.gone

def other(draft):
    draft.main(LATER, ("name",), "the rules after a faulty one are applied")
"""

REPEATING = """
from lumen.feature import Feature

FEATURE = Feature(name="repeating", rules=("repeating_rules:check",), codes=("repeating_rules",))
"""
REPEATING_RULES = """
from lumen.language.diagnostics import WARNING, Code
from lumen.project.complaints import MISSING_KEY

UNKNOWN = Code("unknown-key", "names", WARNING, "a key of another package")

def check(draft):
    pass
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project whose name begins with a small letter."""
    root = copied_project(BASE, tmp_path / "project")
    text = (root / "lumen.yaml").read_text()
    assert "name: Small" in text
    (root / "lumen.yaml").write_text(text.replace("name: Small", "name: small"))
    return root


def found(root: Path) -> Iterator[str]:
    for each in check_files(root, read_files(root))[1]:
        yield f"{each.place} {each.code} | {each.message}"


@pytest.mark.once
@pytest.mark.process
def test_its_finding_is_listed_and_its_code_can_be_selected(stranger: Path, project: Path, capsys) -> None:
    assert list(found(project)) == [f"lumen.yaml:1:7 {CODE} | the name `small` begins with a small letter"]
    for select, count in (("names", 1), ("small", 1), (CODE, 1), ("speech", 0)):
        main(["lint", str(project), "--format", "json", "--select", select])
        assert [d["code"] for d in json.loads(capsys.readouterr().out)["diagnostics"]] == [CODE] * count
    assert "names" in families()


def test_a_code_of_lumen_is_not_replaced(installed: Installed) -> None:
    installed.write("lumen-repeating", REPEATING, repeating_rules=REPEATING_RULES)
    assert (codes()["unknown-key"].family, codes()["unknown-key"].summary) == ("shape", "a key is not allowed here")
    (only,) = found(BASE)
    assert "the installed package `lumen-repeating` 1.0 is faulty: its code `unknown-key` is ignored" in only
    assert "the feature `core` has that name" in only


@pytest.mark.process
def test_its_code_is_explained(stranger: Path, capsys) -> None:
    main(["explain", CODE])
    printed = capsys.readouterr().out
    assert f"{CODE}  warning, names" in printed
    assert "A name begins with a capital letter." in printed
    assert [d.code for d in said(page(CODE).wrong)] == [CODE]
    assert said(page(CODE).right) == []


@pytest.mark.process
def test_its_finding_is_repaired(stranger: Path, project: Path) -> None:
    main(["lint", str(project), "--fix"])
    assert (project / "lumen.yaml").read_text().startswith("name: Small\n")


@pytest.mark.process
def test_its_finding_is_shown_in_an_editor(stranger: Path, project: Path) -> None:
    command = ["env", f"PYTHONPATH={os.environ['PYTHONPATH']}", sys.executable, "-m", "lumen", "lsp", "--stdio"]
    with Client(project, command) as client:
        client.open("lumen.yaml")
        shown = client.diagnostics("lumen.yaml")
    assert [each["code"] for each in shown] == [CODE]


@pytest.mark.process
def test_a_changed_rule_changes_kept_findings(stranger: Path, stranger_lumen: Lumen, project: Path, tmp_path) -> None:
    def lint() -> str:
        return stranger_lumen(project, "lint", "--format", "concise").stdout

    assert "begins with a small letter" in lint()
    rules = stranger / "lumen_stranger/rules.py"
    before = rules.read_text()
    try:
        rules.write_text(before.replace("begins with a small", "does not begin with a capital"))
        assert "does not begin with a capital letter" in lint()
    finally:
        rules.write_text(before)
    assert "begins with a small letter" in lint()


def test_a_rule_that_raises_is_one_finding_and_the_others_are_applied(installed: Installed, project: Path) -> None:
    installed.write("faulty", FAULTY, faulty_rules=FAULTY_RULES)
    broken, other = found(project)
    assert broken == (
        "lumen.yaml:1:1 broken-feature | the installed package `faulty` 1.0 is faulty: "
        "its rule `faulty_rules:check` raised AttributeError: 'str' object has no attribute 'gone'"
    )
    assert "later" in other


def test_a_repair_that_raises_names_its_distribution(
    installed: Installed, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest = FAULTY.replace("rules=", 'fixes={"later": "faulty_rules:check"}, rules=')
    installed.write("faulty", manifest, faulty_rules=FAULTY_RULES)
    assert main(["lint", str(project), "--fix"]) == 0  # as lint returns for the findings that are left
    assert "the installed package `faulty` 1.0 is faulty: its module `faulty_rules:check` raised TypeError" in (
        capsys.readouterr().err
    )


def test_a_rule_of_lumen_that_raises_ends_lint(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def check(draft: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("lumen.lint.traps.check", check)
    with pytest.raises(ZeroDivisionError):
        list(found(project))


def test_a_code_without_a_page_is_explained_by_its_summary(
    installed: Installed, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", FAULTY, faulty_rules=FAULTY_RULES)
    assert codes()["later"].family == "names"
    assert page("later").what == "Found by a rule after a faulty one."
    main(["explain", "later"])
    assert capsys.readouterr().out == "later  warning, names\n\nFound by a rule after a faulty one.\n"


@pytest.mark.parametrize("module", ["1 / 0", "import not_installed"])
def test_a_module_of_rules_that_cannot_be_imported_is_one_finding(
    module: str, installed: Installed, project: Path
) -> None:
    manifest = FAULTY.replace("rules=", "codes=('faulty_rules',), rules=")
    installed.write("faulty", manifest, faulty_rules=module)
    (finding,) = found(project)
    assert "broken-feature" in finding
    assert "later" not in codes()


def test_unused_things_are_reported_after_all_other_rules(installed: Installed, project: Path) -> None:
    assert "lumen.lint.unused:check" in [rule for _, rule in rows("last_rules")]
    assert "lumen.lint.unused:check" not in [rule for _, rule in rows("rules")]


def test_a_rule_of_a_section_or_a_file_runs_only_if_the_project_has_it(installed: Installed, project: Path) -> None:
    rules = "section_rules={'robot.name': 'faulty_rules:other', 'aliases': 'faulty_rules:check'}"
    installed.write("faulty", FAULTY.partition("rules=")[0] + rules + ")", faulty_rules=FAULTY_RULES)
    (finding,) = found(project)
    assert "later" in finding
    main_file = project / "lumen.yaml"
    main_file.write_text(main_file.read_text().replace("name: TINY, ", ""))
    assert not [each for each in found(project) if "later" in each]
    main_file.write_text(main_file.read_text() + "aliases: false\n")
    (finding,) = [each for each in found(project) if "faulty" in each]
    assert "its rule `faulty_rules:check` raised AttributeError" in finding
    assert "later" in codes()
