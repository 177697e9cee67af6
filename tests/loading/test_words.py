"""Words files: part of the behaviours that name them, in a project, beside a lone file and in exports."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from lumen.errors import ProjectError
from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.xstate import read_xstate, write_xstate
from lumen.insight.changes import changes
from lumen.insight.changes.change import Risk
from lumen.insight.changes.machines import machine_changes
from lumen.language.diagnostics import has_errors
from lumen.lint import check_files
from lumen.project import load
from lumen.project.building import draft
from lumen.project.files import read_files
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Interpreter, Machine
from tests import ROOT

FAQ = "behaviors/words/faq.yaml"
TALL: dict[str, Any] = {
    "answers": {"faq": [{"phrases": {"en": ["how tall"], "id": ["tinggi"]}, "value": {"en": "57 cm", "id": "57"}}]}
}
ASKED: dict[str, Any] = {
    "words": "faq",
    "context": {"said": ""},
    "states": {
        "a": {
            "on": {
                "heard": {
                    "guard": "lookup(event.data, 'faq') != null",
                    "actions": {"assign": {"said": "lookup(event.data, 'faq')"}},
                }
            }
        }
    },
}


def said(machine: Machine) -> Any:
    it = Interpreter(machine, language="en")
    it.start()
    it.send("heard", "How tall are you?")
    return it.context["said"]


def test_a_lone_file_has_its_words_beside_it(tmp_path: Path) -> None:
    (tmp_path / "words").mkdir()
    (tmp_path / "words" / "faq.yaml").write_text("answers: {faq: [{phrases: {en: [how tall]}, value: {en: 57 cm}}]}\n")
    (tmp_path / "asked.yaml").write_text(
        "words: faq\ncontext: {said: ''}\nstates:\n  a:\n    on:\n      heard:\n"
        "        actions: {assign: {said: \"lookup(event.data, 'faq')\"}}\n"
    )
    assert said(Machine.load(tmp_path / "asked.yaml")) == "57 cm"
    (tmp_path / "words" / "faq.yaml").write_text("answers: {faq: 3}\n")
    with pytest.raises(ProjectError, match=r"faq\.yaml:1:16"):
        Machine.load(tmp_path / "asked.yaml")


def test_a_dict_names_its_words() -> None:
    assert said(Machine.from_dict(ASKED, words={"faq": TALL})) == "57 cm"
    with pytest.raises(ProjectError, match="there is no words file `faq`"):
        Machine.from_dict(ASKED)


def test_other_words_make_another_machine() -> None:
    other = {"answers": {"faq": [{"phrases": {"en": ["how tall"]}, "value": {"en": "58 cm"}}]}}
    one, two = (Machine.from_dict(ASKED, words={"faq": words}) for words in (TALL, other))
    assert one.hash != two.hash


def test_words_go_along_into_other_formats_and_come_back() -> None:
    machine = Machine.from_dict(ASKED, words={"faq": TALL})
    scxml, _ = write_scxml(machine, dotted("asked"))
    back, found = read_scxml("asked.scxml", scxml.encode(), "asked")
    assert not has_errors(found)
    assert said(Machine.from_dict(back)) == "57 cm"
    xstate, _ = write_xstate(machine, dotted("asked"))
    back, found = read_xstate("asked.json", xstate.encode(), "asked")
    assert not has_errors(found)
    assert said(Machine.from_dict(back)) == "57 cm"


def test_a_change_of_words_is_seen_at_once_and_told_once_in_their_file() -> None:
    """A behaviour is read again if only the words that it names have changed."""
    files = {**read_files(ROOT), "behaviors/guide.yaml": b"words: faq\nstates: {a: {on: {heard: a}}}\n"}
    old = b"I weigh a little more than five kilograms."
    before, _ = check_files(ROOT, files)
    after, _ = check_files(ROOT, {**files, FAQ: files[FAQ].replace(old, b"Five kilograms.")})
    assert before
    assert after
    (change,) = changes(before, after)
    assert (change.file, change.risk) == (FAQ, Risk.COSMETIC)
    assert change.sentence == "`faq` now answers “Five kilograms.”"


@pytest.mark.parametrize(
    ("words", "others", "told"),
    [
        ({"lists": {"rooms": [{"of": "us"}]}}, {"lists": {"rooms": [{"of": "all"}]}}, "list `rooms` changed"),
        ({"phrases": {"hi": {"en": ["hi"]}}}, {"phrases": {"hi": {"en": ["hello"]}}}, "phrases `hi`"),
        (
            {"phrases": {"hi": {"en": ["hi"]}}},
            {"phrases": {"hi": {"en": ["hi"]}, "ho": {"en": ["ho"]}}},
            "phrases `ho`",
        ),
    ],
)
def test_a_change_of_what_a_words_file_has_names_that_file(words: Any, others: Any, told: str) -> None:
    data = {"id": "m", "words": "faq", "states": {"a": {}}}
    old, new = (Machine.from_dict(data, words={"faq": each}) for each in (words, others))
    (change,) = machine_changes("m", old, new)
    assert change.sentence.startswith(told)
    assert change.file == FAQ


def test_the_shipped_answers_stand_in_words() -> None:
    """The words that come with Lumen are there as far as they are in a language of the project."""
    project = load(ROOT)
    machine, words = project.machine, draft(read_files(ROOT)).words

    def spoken(phrases: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
        return {language: texts for language, texts in phrases.items() if language in project.languages}

    common_answers = {
        name: tuple(replace(answer, phrases=spoken(answer.phrases)) for answer in answers if spoken(answer.phrases))
        for name, answers in words["common"].answers.items()
    }
    common_phrases = {name: spoken(phrases) for name, phrases in words["common"].phrases.items()}
    assert {machine.borrowed["answers", name] for name in machine.answers} == {"common", "faq"}
    assert {machine.borrowed["phrases", name] for name in machine.phrases} == {"common", "visitors"}
    assert {**words["faq"].answers, **common_answers} == machine.answers
    assert {**words["visitors"].phrases, **common_phrases} == machine.phrases
