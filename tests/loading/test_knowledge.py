"""Passages of YAML and Markdown files, the parts of them that count, and the names of their changes."""

from datetime import date
from pathlib import Path

from lumen.insight.changes import changes
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import fingerprint, read_files
from lumen.project.knowledge import parse_markdown
from tests import ROOT
from tests.tables import for_each

BASE = ROOT / "tests/lint/base"
YAML = b"questions: {en: how tall, id: [tinggi]}\nanswer: {en: Small., id: Kecil.}\nuntil: 2999-01-02\nwho: TINY\n"
MARKDOWN = b"---\nquestions: {en: what is this, id: apa ini}\n---\n# en\n\nAn organ\nwith pipes.\n\n# id\n\nOrgel.\n"


def project(**passages: bytes) -> Project:
    files = {f"knowledge/{name.replace('_', '.')}": content for name, content in passages.items()}
    built, found = check_files(BASE, {**read_files(BASE), **files})
    assert built, found
    return built


def test_a_passage_is_built_of_yaml_and_of_markdown() -> None:
    known = project(height_yaml=YAML, organ_md=MARKDOWN).knowledge
    assert known["height"].questions == {"en": ("how tall",), "id": ("tinggi",)}
    assert known["height"].until == date(2999, 1, 2)
    assert known["height"].is_said_by("TINY")
    assert not known["height"].is_said_by("other")
    assert known["organ"].answer == {"en": "An organ with pipes.", "id": "Orgel."}
    assert known["organ"].file == "knowledge/organ.md"


def test_its_last_day_counts() -> None:
    passage = project(height_yaml=YAML).knowledge["height"]
    assert not passage.is_past(date(2999, 1, 2))
    assert passage.is_past(date(2999, 1, 3))


def test_passages_belong_to_the_bundle(tmp_path: Path) -> None:
    (tmp_path / "knowledge").mkdir()
    before = fingerprint(read_files(tmp_path))
    (tmp_path / "knowledge" / "organ.md").write_bytes(MARKDOWN)
    assert fingerprint(read_files(tmp_path)) != before


def test_a_change_is_told_with_its_file() -> None:
    old = project(height_yaml=YAML, organ_md=MARKDOWN)
    new = project(height_yaml=YAML.replace(b"Small", b"Tall"), hours_yaml=YAML.replace(b"tall", b"long"))
    told = [(change.sentence, change.file) for change in changes(old, new)]
    assert told == [
        ("passage `height` changed", "knowledge/height.yaml"),
        ("passage `organ` removed", "knowledge/organ.md"),
        ("passage `hours` added", "knowledge/hours.yaml"),
    ]


@for_each("content", [b"", b"---\n---\n", b"---\n- a\n---\n# en\n", b"---\n\xff\n---\n", b"\xff"])
def test_any_content_is_told_and_never_raises(content: bytes) -> None:
    document, found = parse_markdown("knowledge/a.md", content)
    assert found or (document and not isinstance(document.data, dict))
    built, told = check_files(BASE, {**read_files(BASE), "knowledge/a.md": content})
    assert built is None
    assert told
