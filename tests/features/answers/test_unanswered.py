"""Unanswered questions are on the console's list, without names, and become passages with one edit."""

from datetime import date
from pathlib import Path
from typing import Any

import pytest
import yaml

import lumen
from lumen.errors import UsageError
from lumen.features.console.day import day_of
from lumen.insight.replay.entries import JournalInput
from lumen.language.command_data import command_data
from lumen.language.commands import Ask, Start
from lumen.language.events import Event
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.new_passage import write_passage
from tests.tables import for_each


def asks(position: int, id: str, question: str) -> JournalInput:
    said = command_data(Start(id, Ask(question, "en", 4.0)))
    return JournalInput(position, "heard", Event("heard", {"result": question.upper()}), commands=(said,))


def hears(position: int, name: str, **data: Any) -> JournalInput:
    return JournalInput(position, "heard", Event(name, data))


def test_only_what_nobody_answered_is_listed() -> None:
    entries = [
        asks(0, "d1", "what is love"),
        hears(1, "error.command.d1", reason="nobody"),
        asks(2, "d2", "how tall are you"),
        hears(3, "answer.command.d2", text="Small."),
        asks(4, "d3", "what is love"),
        hears(5, "answer.command.d3", text="Let me think.", filler=True),
        asks(6, "d1", "who wins"),
        hears(7, "answer.command.d1", **{"raise": {"event": "wish.dance", "data": {}}}),
    ]
    day = day_of(entries, lambda *_: None, date(1970, 1, 1))
    numbers = day.to_json()["numbers"]
    assert numbers["unanswered"] == [{"text": "what is love", "language": "en", "count": 2}]
    assert dict(numbers["missed"]) == {"what is love": 2}


def test_it_becomes_a_passage_that_lint_takes(tmp_path: Path) -> None:
    file = write_passage(tmp_path, "  Ist das Café\nauf: ja?", "Ja: bis 18 Uhr.", "de")
    assert file == Path("knowledge/ist-das-cafe-auf-ja.yaml")
    text = (tmp_path / file).read_text("utf-8")
    assert yaml.safe_load(text) == {"questions": {"de": ["Ist das Café auf: ja?"]}, "answer": {"de": "Ja: bis 18 Uhr."}}
    assert write_passage(tmp_path, "ist das cafe auf, ja", "Nein.", "de").name == "ist-das-cafe-auf-ja-2.yaml"
    assert (tmp_path / file).read_text("utf-8") == text
    assert write_passage(tmp_path, "宇宙は", "x", "ja").name == "question.yaml"


def test_the_robot_answers_it_from_then_on(tmp_path: Path) -> None:
    file = write_passage(tmp_path, "what is love", "A question.", "en")
    root = Path(lumen.load(".").root)
    files = {**read_files(root), file.as_posix(): (tmp_path / file).read_bytes()}
    project, found = check_files(root, files)
    assert project
    assert {one.code for one in found} <= {"missing-language"}
    assert project.knowledge["what-is-love"].answer == {"en": "A question."}


@for_each(
    ("question", "answer", "language"),
    [("", "x", "en"), ("?", "x", "en"), ("x", " ", "en"), ("x" * 1001, "x", "en"), ("x", "x", "../en"), ("x", "x", "")],
)
def test_what_is_none_is_refused(tmp_path: Path, question: str, answer: str, language: str) -> None:
    with pytest.raises(UsageError):
        write_passage(tmp_path, question, answer, language)
    assert not (tmp_path / "knowledge").exists()


def test_a_folder_that_is_a_link_is_not_written(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "knowledge").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(UsageError, match="a symbolic link"):
        write_passage(tmp_path, "x", "x", "en")
    assert list((tmp_path / "elsewhere").iterdir()) == []
