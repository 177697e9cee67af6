"""The settings of features in sections of lumen.yaml: read if present, else their defaults."""

import json
import shutil
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import get_type_hints

import pytest

import lumen
from lumen.feature import resolve, table
from lumen.features.alerts.settings import DEFAULT_INTERVAL, Alerts, Program
from lumen.insight.changes import changes, live
from lumen.language.projects import Project
from lumen.run.reload.delta import DeltaDecoder, DeltaEncoder
from tests import ROOT
from tests.copying import copied_project
from tests.tables import for_each


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A copy of a small project without any section of a feature."""
    return copied_project(ROOT / "tests/lint/base", tmp_path / "small")


def with_section(folder: Path, text: str) -> Project:
    main = folder / "lumen.yaml"
    main.write_text(f"{main.read_text('utf-8')}\n{text}\n", "utf-8")
    return lumen.load(folder)


def test_a_section_has_its_settings_and_an_absent_one_has_defaults(small: Path) -> None:
    assert lumen.load(small).section(Alerts) == Alerts()
    [recipient] = with_section(small, "alerts: {to: [{command: [./page.sh]}]}").section(Alerts).to
    assert recipient.channel == Program(("./page.sh",))


def test_a_section_that_repeats_its_defaults_is_as_good_as_none(small: Path) -> None:
    before = lumen.load(small)
    after = with_section(small, f"alerts: {{to: [], interval: {DEFAULT_INTERVAL:g}s}}")
    assert after.sections == before.sections
    assert changes(before, after) == ()


def test_a_section_that_goes_is_one_change(small: Path) -> None:
    before = lumen.load(small)
    after = with_section(small, "alerts: {to: [{command: [./page.sh]}]}")
    sentence = "the recipients of alerts (`alerts`) changed"
    assert [change.sentence for change in changes(before, after)] == [sentence]
    assert [change.sentence for change in changes(after, before)] == [sentence]


NEXT = "changed: it takes effect at the next start"
CHANGED = {
    "shared": ("{stage: {owner: TINY, type: string}}", "shared key `stage` added (behavior)"),
    "places": ("{organ: {x: 0.1, y: 0.2}}", "place `organ` added (behavior)"),
    "imperfections": ("{noise: false}", f"the robot's imperfections {NEXT} (restart)"),
    "alerts": ("{to: [{command: [./page.sh]}]}", "the recipients of alerts (`alerts`) changed (cosmetic)"),
    "journal": ("{keep: 7}", "`journal.keep` is now `7`, not `30` (cosmetic)"),
    "record": ("{keep: 7}", "`record.keep` is now `7`, not `30` (cosmetic)"),
    "reload": ("{replay: warn}", "the check of saved files on recorded visits (`reload`) changed (cosmetic)"),
    "console": ("{port: 8123}", f"the console {NEXT} (restart)"),
    "modules.show": (
        "{mqtt: {host: h}}",
        "the output to lamps, screens and sound desks (`modules.show`) changed (wiring)",
    ),
}
"""For each section of Lumen's own: settings, and how a list of changes describes them."""


@for_each("key", CHANGED)
def test_a_section_that_comes_is_described_and_travels(key: str, tmp_path: Path) -> None:
    text, sentence = CHANGED[key]
    folder = copied_project(ROOT / "tests/lint/base", tmp_path / "small")
    above, _, name = key.rpartition(".")
    without = with_section(folder, f"{above}: {{{name}: {{here: false}}}}") if above else lumen.load(folder)
    shutil.copy(ROOT / "tests/lint/base/lumen.yaml", folder)
    after = with_section(folder, f"{above}: {{{name}: {text}}}" if above else f"{key}: {text}")
    found = [f"{change} ({change.risk})" for change in changes(without, after)]
    assert found == [*(["context key `shared` added (behavior)"] if key == "shared" else []), sentence]
    assert [*after.sections] == [key]
    assert live(without, after).sections == ({} if NEXT in sentence else after.sections)
    assert DeltaDecoder().unpack(DeltaEncoder().pack(after)) == after


def test_every_section_of_lumen_has_a_schema_and_settings_with_defaults() -> None:
    schema = json.loads((ROOT / "schemas/lumen.schema.json").read_bytes())
    for key, row in table("sections").items():
        node = schema
        for step in key.split("."):
            node = node["properties"][step]
        kind = get_type_hints(resolve(row.read))["return"]
        assert is_dataclass(kind)
        assert kind() == kind()
        assert not row.entries or row.entries in {field.name for field in fields(kind)}
    assert table("sections").keys() == CHANGED.keys()
