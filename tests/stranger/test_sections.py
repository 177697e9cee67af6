"""A section of lumen.yaml that an installed package adds: checked, read, completed, compared and reloaded."""

import json
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.feature import resolve
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.hover import hover
from lumen.features.fleet.bundle_trial import at_home
from lumen.insight.changes import changes, live
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.reload.delta import DeltaDecoder, DeltaEncoder
from lumen.run.reload.idle_process import end_idle
from lumen.run.reload.validation_worker import ValidationWorker
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import SOURCES, Installed
from tests.tables import for_each

LAMP_MODULE = (SOURCES / "lumen_stranger/lamp.py").read_text()
MANIFEST = """\
from lumen.feature import Feature, Section

FEATURE = Feature(
    name="lamp",
    sections={
        "lamp": Section(
            read="lamp_settings:read_lamp", schema="lamp_settings:SCHEMA", title="scene of the lamp", entries="scenes"
        )
    },
)
"""
LAMP = "lamp: {first: night, scenes: {night: 0.1, day: 1}}\n"


def files(lamp: str) -> dict[str, bytes]:
    """Return the files of a small project with this text at the end of lumen.yaml."""
    small = read_files(ROOT / "tests/lint/base")
    return {**small, "lumen.yaml": small["lumen.yaml"] + lamp.encode()}


def project(lamp: str) -> Project:
    found, diagnostics = check_files(ROOT, files(lamp))
    assert found, diagnostics
    return found


def marked(lamp: str) -> list[tuple[str, str, str, str]]:
    """Return the findings in lumen.yaml: code, marked text, message and hint."""
    texts = files(lamp)["lumen.yaml"].decode().split("\n")
    found = []
    for each in check_files(ROOT, files(lamp))[1]:
        word = texts[each.place.line - 1][each.place.column - 1 : each.place.end_column - 1]
        found.append((str(each.code), word, each.message, each.hint))
    return found


def settings_of(some: Project) -> Any:
    """Return the settings of the stranger's section."""
    return some.section(resolve("lumen_stranger.lamp:Lamp"))


@pytest.mark.process
def test_the_settings_are_read(stranger: Path) -> None:
    lamp = settings_of(project(LAMP))
    assert (lamp.first, lamp.scenes) == ("night", {"night": 0.1, "day": 1})
    assert settings_of(project("")) == type(lamp)()


@pytest.mark.process
@for_each(
    ("lamp", "code", "word", "told"),
    [
        ("lamp: {scenes: {night: 2}}\n", "wrong-value", "2", "1"),
        ("lamp: {sceens: {night: 1}}\n", "unknown-key", "sceens", "did you mean `scenes`?"),
        ("lamb: {scenes: {night: 1}}\n", "unknown-key", "lamb", "did you mean `lamp`?"),
        ("lamp: {first: day, scenes: {night: 1}}\n", "no-scene", "day", "the lamp has no scene `day`"),
    ],
)
def test_lint_finds_mistakes_at_their_words(lamp: str, code: str, word: str, told: str, stranger: Path) -> None:
    [(found, text, message, hint)] = marked(lamp)
    assert (found, text) == (code, word)
    assert told in f"{message} {hint}"


def test_without_the_package_the_section_is_an_unknown_key() -> None:
    assert [(code, word) for code, word, *_ in marked(LAMP)] == [("unknown-key", "lamp")]


@pytest.mark.process
def test_each_entry_that_differs_is_a_change(stranger: Path) -> None:
    old, new = project(LAMP), project("lamp: {first: day, scenes: {day: 0.9, evening: 0.5}}\n")
    assert [(str(each), str(each.risk)) for each in changes(old, new)] == [
        ("scene of the lamp `night` removed", "wiring"),
        ("scene of the lamp `day` changed", "wiring"),
        ("scene of the lamp `evening` added", "wiring"),
        ("`lamp` changed", "wiring"),
    ]
    assert [str(each) for each in changes(old, project(""))] == [
        "scene of the lamp `night` removed",
        "scene of the lamp `day` removed",
        "`lamp` changed",
    ]
    assert live(old, new).sections == new.sections


def test_a_section_that_takes_effect_at_the_next_start_stays_as_it_was(installed: Installed) -> None:
    fixed = MANIFEST.replace('title="scene of the lamp", entries="scenes"', 'title="the lamp", risk="restart"')
    installed.write("lumen-lamp", fixed, lamp_settings=LAMP_MODULE)
    old, new = project(LAMP), project("lamp: {scenes: {day: 1}}\n")
    assert [str(each) for each in changes(old, new)] == ["the lamp changed: it takes effect at the next start"]
    assert live(old, new).sections == old.sections
    assert live(old, project("")).sections == old.sections


@pytest.mark.process
def test_a_section_that_is_the_same_stays_the_same_object_in_another_process(stranger: Path) -> None:
    sender, receiver = DeltaEncoder(), DeltaDecoder()
    before = receiver.unpack(sender.pack(project(LAMP)))
    after = receiver.unpack(sender.pack(project(f"alerts: {{to: [{{command: [./page.sh]}}]}}\n{LAMP}")))
    assert [*after.sections] == ["alerts", "lamp"]
    assert settings_of(after) is settings_of(before)


@pytest.mark.process
@pytest.mark.slow
def test_saved_files_are_judged_with_the_section(stranger: Path, tmp_path: Path) -> None:
    end_idle()  # a process that another test began would not find the package
    root = copied_project(ROOT / "tests/lint/base", tmp_path / "small")
    judge = ValidationWorker(root)
    judge.begin()
    found, diagnostics = judge.load(files(LAMP))
    assert found, diagnostics
    assert settings_of(found).first == "night"
    found, diagnostics = judge.load(files("lamp: {first: day, scenes: {night: 1}}\n"))
    assert (found, [str(each.code) for each in diagnostics]) == (None, ["no-scene"])
    judge.close()
    end_idle()


@pytest.mark.process
def test_lumen_diff_prints_the_entries(stranger: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, lamp in (("old", LAMP), ("new", "lamp: {first: night, scenes: {night: 0.2, day: 1}}\n")):
        root = copied_project(ROOT / "tests/lint/base", tmp_path / name)
        (root / "lumen.yaml").write_bytes(files(lamp)["lumen.yaml"])
    assert main(["diff", str(tmp_path / "old"), str(tmp_path / "new")]) == 0
    assert "lumen.yaml\n  scene of the lamp `night` changed (wiring)\n" in capsys.readouterr().out


@pytest.mark.process
def test_the_editor_completes_and_explains_the_section(stranger: Path) -> None:
    analysis = Analysis(ROOT, files("la\n"))
    last = analysis.text("lumen.yaml").count("\n")
    assert "lamp" in [item.text.rstrip(": ") for item in complete(analysis, "lumen.yaml", last, 3)]
    analysis = Analysis(ROOT, files("lamp:\n  scenes: {night: 1}\n  f\n"))
    assert "first" in [item.text.rstrip(": ") for item in complete(analysis, "lumen.yaml", last + 2, 4)]
    assert hover(analysis, "lumen.yaml", last, 2) == "`lamp`: A lamp on the stage"
    assert hover(analysis, "lumen.yaml", last + 1, 4) == "`scenes`: How bright each scene is, from 0 to 1"


@pytest.mark.process
def test_lumen_schema_prints_the_section(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "lumen"]) == 0
    properties = json.loads(capsys.readouterr().out)["properties"]
    assert properties["lamp"]["description"] == "A lamp on the stage"
    shipped = json.loads((ROOT / "schemas/lumen.schema.json").read_bytes())["properties"]
    assert [*properties] == [*shipped, "lamp"]


@pytest.mark.process
def test_a_bundle_of_a_fleet_leaves_the_section_of_a_house(stranger: Path) -> None:
    assert at_home(b"name: Tour\nlamp: {scenes: {day: 1}}\n", LAMP.encode()) == f"name: Tour\n{LAMP}".encode()


def test_a_bundle_leaves_a_section_below_a_key_of_its_own(installed: Installed) -> None:
    row = MANIFEST.replace('"lamp": Section(', '"light.lamp": Section(of_house=True, ')
    installed.write("lumen-lamp", row, lamp_settings=LAMP_MODULE)
    own = b"light: {lamp: {scenes: {night: 1}}}\n"
    assert at_home(b"name: Tour\nlight: {lamp: {scenes: {day: 1}}}\n", own) == b"name: Tour\n" + own


BROKEN = {
    "its reader raises": ('data["lamp"]', "1 / 0", "ZeroDivisionError: division by zero"),
    "its reader is missing": ("def read_lamp", "def read", "AttributeError"),
    "its schema is missing": ("SCHEMA = {", "SCHEME = {", "AttributeError"),
    "its schema is unsound": ('"object"', '"map"', "is no JSON Schema, or has `$ref`"),
    "its schema has a reference": ('"type": "string"', '"$ref": "#/$defs/host"', "is no JSON Schema, or has `$ref`"),
    "its settings lack a default": ('first: str = ""', "first: str", "TypeError"),
    "its reader returns nothing": ("return lamp", "return None", "returns no dataclass"),
    "its entries are no mapping": ('entries="scenes"', 'entries="first"', "`first` of its settings is no mapping"),
    "it has no such entries": ('entries="scenes"', 'entries="sceens"', "AttributeError"),
}


@for_each("case", BROKEN)
def test_a_section_that_can_not_be_read_is_one_finding_that_names_its_package(case: str, installed: Installed) -> None:
    right, wrong, told = BROKEN[case]
    assert right in MANIFEST + LAMP_MODULE
    manifest, module = MANIFEST.replace(right, wrong), LAMP_MODULE.replace(right, wrong)
    installed.write("lumen-lamp", manifest, lamp_settings=module)
    [(code, word, message, _)] = marked(LAMP)
    assert (code, word) == ("broken-feature", "lamp")
    assert "`lumen-lamp` 1.0 is faulty: reading `lamp` raised" in message
    assert told in message
    assert project(LAMP).sections == {}
    assert marked("") == []


@for_each(
    ("right", "wrong", "told"),
    [
        (
            'entries="scenes"',
            'risk="great"',
            "no risk `great`: choose one of cosmetic, behavior, motion, wiring, restart",
        ),
        ("Section(\n", "dict(\n", "which is no `Section`"),
    ],
)
def test_a_wrong_row_is_a_fault_of_the_manifest(right: str, wrong: str, told: str, installed: Installed) -> None:
    assert right in MANIFEST
    installed.write("lumen-lamp", MANIFEST.replace(right, wrong), lamp_settings=LAMP_MODULE)
    [(code, _, message, _)] = marked("")
    assert code == "broken-feature"
    assert told in message


@for_each("key", ["modules.lamp", "light.lamp", "name.lamp"])
def test_a_key_with_dots_is_below_another(key: str, installed: Installed) -> None:
    below, _, name = key.partition(".")
    read = LAMP_MODULE.replace('data["lamp"]', f'data["{below}"]["{name}"]')
    installed.write("lumen-lamp", MANIFEST.replace('"lamp":', f'"{key}":'), lamp_settings=read)
    assert marked("") == []
    if below != "name":  # which is a text
        assert project(f"{below}: {{lamp: {{scenes: {{night: 1}}}}}}\n").sections.keys() == {key}
