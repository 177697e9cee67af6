"""The settings of features in sections of lumen.yaml: read if present, else their defaults."""

import shutil
from pathlib import Path

import pytest

import lumen
from lumen.interpreters.changes import changes
from lumen.language.alerts import DEFAULT_INTERVAL, Alerts, Program
from lumen.language.projects import Project
from tests import ROOT


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A copy of a small project without any section of a feature."""
    return shutil.copytree(ROOT / "tests/lint/base", tmp_path / "small")


def with_alerts(folder: Path, text: str) -> Project:
    main = folder / "lumen.yaml"
    main.write_text(f"{main.read_text('utf-8')}\n{text}\n", "utf-8")
    return lumen.load(folder)


def test_a_section_has_its_settings_and_an_absent_one_has_defaults(small: Path) -> None:
    assert lumen.load(small).section(Alerts) == Alerts()
    [recipient] = with_alerts(small, "alerts: {to: [{command: [./page.sh]}]}").section(Alerts).to
    assert recipient.channel == Program(("./page.sh",))


def test_a_section_that_repeats_its_defaults_is_as_good_as_none(small: Path) -> None:
    before = lumen.load(small)
    after = with_alerts(small, f"alerts: {{to: [], interval: {DEFAULT_INTERVAL:g}s}}")
    assert after.sections == before.sections
    assert changes(before, after) == ()


def test_a_section_that_goes_is_one_change(small: Path) -> None:
    before = lumen.load(small)
    after = with_alerts(small, "alerts: {to: [{command: [./page.sh]}]}")
    sentence = "the recipients of alerts (`alerts`) changed"
    assert [change.sentence for change in changes(before, after)] == [sentence]
    assert [change.sentence for change in changes(after, before)] == [sentence]
