"""`lumen language` adds a place for a new language beside each text, and lists missing texts."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.lint import check_files
from lumen.lint.new_language import with_language
from lumen.lint.translation import TO_DO, language_entries, untranslated
from lumen.project.building import draft
from lumen.project.files import read_files
from tests import ROOT

BEHAVIOR = """\
id: hello
entry: {wake: true}
phrases:
  bye:   # how people go
    en:
      - goodbye
      # in short
      - bye

states:
  waiting: {on: {face: greeting}}
  greeting:
    do:
      - say:
          en: >-
            # This is no comment,
            and goes on.


      - {say: {en: Hello!}}  # two of them
      - say: "{{ state.path }}"
    on: {heard: {guard: "heard(event.data.result, 'bye')", target: waiting}}
"""
TRANSLATED = """\
id: hello
entry: {wake: true}
phrases:
  bye:   # how people go
    en:
      - goodbye
      # in short
      - bye
    de: ["TODO goodbye", "TODO bye"]

states:
  waiting: {on: {face: greeting}}
  greeting:
    do:
      - say:
          en: >-
            # This is no comment,
            and goes on.
          de: "TODO # This is no comment, and goes on."


      - {say: {en: Hello!, de: "TODO Hello!"}}  # two of them
      - say: "{{ state.path }}"
    on: {heard: {guard: "heard(event.data.result, 'bye')", target: waiting}}
"""


@pytest.fixture
def hall(tmp_path: Path) -> Path:
    assert main(["new", str(tmp_path / "hall"), "--minimal"]) == 0
    (tmp_path / "hall/behaviors/hello.yaml").write_text(BEHAVIOR, "utf-8")
    (tmp_path / "hall/behaviors/stories/visitor.yaml").unlink()
    main_file = tmp_path / "hall/lumen.yaml"
    text = main_file.read_text("utf-8").replace("languages: [en] ", "languages:\n  - en\n").replace("story: ", "# ")
    main_file.write_text(text, "utf-8")
    return tmp_path / "hall"


def without(data: Any, language: str) -> Any:
    """Return the data without its entries for that language."""
    if isinstance(data, dict):
        return {key: without(value, language) for key, value in data.items() if key != language}
    return [without(value, language) for value in data if value != language] if isinstance(data, list) else data


def comments(content: bytes) -> list[str]:
    """Return the comments, except those that mark a text to translate; a target such as "#goodbye" is not a comment."""
    lines = (line for line in content.decode().splitlines() if TO_DO not in line)
    return [line[found.start() :] for line in lines if (found := re.search(r"(^|\s)#(?=\s)", line))]


@pytest.mark.slow
@pytest.mark.parametrize("folder", [".", "examples/museum"])
def test_a_new_language_has_a_place_everywhere_and_nothing_else_changes(folder: str) -> None:
    root = ROOT / folder
    files = read_files(root)
    before = draft(files)
    after = {**files, **with_language(before, files, "fr", "en")}
    project, diagnostics = check_files(root, after)
    assert project
    assert project.languages[-1] == "fr"
    copied = {"shadowed-question"}  # the French questions are copies of the English ones
    assert {diagnostic.code for diagnostic in diagnostics} - copied == {"missing-language", "missing-words"}
    then = draft(after)
    for file in (file for file in files if after[file] != files[file]):
        assert without(then.reports[file].document.data, "fr") == before.reports[file].document.data
        assert comments(after[file]) == comments(files[file])
    entries = language_entries(then)
    assert len(entries) == len(language_entries(before)) == len(list(untranslated(entries, "fr")))
    assert list(untranslated(entries, "en")) == []


def test_it_stands_beside_the_others_and_comments_stay(hall: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["language", "add", "de", "--project", str(hall)]) == 0
    assert "behaviors/hello.yaml: 4 to translate" in capsys.readouterr().out
    assert (hall / "behaviors/hello.yaml").read_text("utf-8") == TRANSLATED
    assert "languages:\n  - en\n  - de\n" in (hall / "lumen.yaml").read_text("utf-8")


def test_check_says_what_is_missing_until_nothing_is(hall: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["language", "check", "--project", str(hall)]) == 0
    assert main(["language", "add", "de", "--project", str(hall)]) == 0
    capsys.readouterr()
    file = hall / "behaviors/hello.yaml"
    text = file.read_text("utf-8").replace("          de:", "          id:")
    (hall / "lumen.yaml").write_text((hall / "lumen.yaml").read_text("utf-8").replace("- de", "- de\n  - id"), "utf-8")
    file.write_text(text, "utf-8")
    assert main(["language", "check", "de", "--project", str(hall)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "behaviors/hello.yaml:15:9 de is missing: # This is no comment, and goes on.",
        "behaviors/hello.yaml:22:28 de is missing: Hello!",
        "behaviors/hello.yaml:9:5 de is missing: goodbye; bye",
        "de: 3 of 3 are missing",
        "de: no action switches the robot to this language: add the action `language: de` for visitors who ask for it",
    ]
    file.write_text(text.replace('de: "TODO Hello!"', "de: Hallo!"), "utf-8")
    assert main(["language", "check", "--format", "json", "--project", str(hall)]) == 1
    said = json.loads(capsys.readouterr().out)["languages"]
    assert {name: (found["texts"], len(found["missing"])) for name, found in said.items()} == {
        "en": (3, 0),
        "de": (3, 2),
        "id": (3, 3),
    }
    assert main(["language", "list", "--project", str(hall)]) == 0


def test_check_lists_a_text_that_is_the_same_in_all_languages(hall: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["language", "add", "de", "--project", str(hall)]) == 0
    file = hall / "behaviors/hello.yaml"
    file.write_text(file.read_text("utf-8").replace("TODO ", "").replace('say: "{{', 'say: "Here: {{'), "utf-8")
    capsys.readouterr()
    assert main(["language", "check", "de", "--project", str(hall)]) == 0
    told = capsys.readouterr().out
    assert "de: all 3 are present" in told
    assert re.search(r"behaviors/hello.yaml:\d+:14 is said in all languages: write one text for each language", told)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["add", "en"], "already has `en`"),
        (["add"], "write `lumen language add LANG`"),
        (["add", "de", "--from", "fr"], "has no language `fr`"),
        (["add", "German"], "`German` is not a language code: write two or three lowercase letters, such as `de`"),
        (["check", "em"], "has no language `em`: it has `en`"),
    ],
)
def test_what_can_t_be_is_one_line(hall: Path, capsys: pytest.CaptureFixture[str], words: list[str], says: str) -> None:
    before = read_files(hall)
    capsys.readouterr()
    assert main(["language", *words, "--project", str(hall)]) == 2
    said = capsys.readouterr().err
    assert says in said
    assert said.count("\n") == 1
    assert read_files(hall) == before


def test_what_is_said_without_a_language_was_said_in_the_only_one(hall: Path) -> None:
    file = hall / "behaviors/hello.yaml"
    file.write_text(BEHAVIOR.replace("{say: {en: Hello!}}", "{say: Hello you!}"), "utf-8")
    assert main(["language", "add", "de", "--project", str(hall)]) == 0
    text = file.read_text("utf-8")
    assert '{say: {en: "Hello you!", de: "TODO Hello you!"}}' in text
    assert '- say: "{{ state.path }}"\n' in text
