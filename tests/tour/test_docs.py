"""The documentation's claims about the files agree with the files and the schemas."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.main import main
from tests import ROOT
from tests.tables import for_each

CHANGE = (ROOT / "docs" / "change-the-tour.md").read_text("utf-8")
VOCABULARY = (ROOT / "docs" / "yaml.md").read_text("utf-8")
PAPER = (ROOT / "docs" / "research.md").read_text("utf-8").partition("\n## The erratum")[0]
BLOCKS = re.findall(r"```yaml\n(.*?)```", CHANGE, re.S)


def change(project: Path, old: str, new: str) -> None:
    """Replace a text of the tour once; it must be there."""
    tour = project / "behaviors" / "tour.yaml"
    text = tour.read_text("utf-8")
    assert old in text
    tour.write_text(text.replace(old, new, 1), "utf-8")


def test_the_state_that_the_tutorial_shows_is_the_one_in_the_tour() -> None:
    assert BLOCKS[1] in (ROOT / "behaviors" / "tour.yaml").read_text("utf-8")


def test_the_tutorials_question_can_be_added(copy: Path) -> None:
    words = copy / "behaviors" / "words" / "faq.yaml"
    words.write_text(words.read_text("utf-8") + BLOCKS[0], "utf-8")
    assert lumen.check(copy) == []
    row = lumen.load(copy).machine.answers["faq"][-1]
    assert "favourite colour" in row.phrases["en"]
    assert {language: len(texts) for language, texts in row.value.items()} == {"en": 2, "id": 2}


def test_the_tutorials_motion_can_be_added(copy: Path) -> None:
    before = BLOCKS[1].partition("                do:\n")[2]
    change(copy, f"                do:\n{before}", BLOCKS[2])
    assert lumen.check(copy) == []


def test_lint_says_what_the_tutorial_quotes(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    change(copy, 'fine: "#fine"\n', 'fine: "#fin"\n')
    (quoted,) = re.findall(r"```console\n\$ lumen lint\n(behaviors/.*?)```", CHANGE, re.S)
    monkeypatch.chdir(copy)
    assert main(["lint"]) == 1
    assert re.sub(r"\d+ files", "all files", capsys.readouterr().out) == re.sub(r"\d+ files", "all files", quoted)


@for_each("kind", ["behavior", "story", "motion", "controller", "lumen"])
def test_the_vocabulary_names_every_key_of_the_schemas(kind: str) -> None:
    schema = json.loads((ROOT / "schemas" / f"{kind}.schema.json").read_text("utf-8"))
    text = re.sub(r"```.*?```", "", VOCABULARY, flags=re.S)
    written = set(re.findall(r"[A-Za-z_]+", " ".join(re.findall(r"`[^`]+`", text))))
    wanted = set(schema["properties"])
    if kind == "behavior":
        wanted |= {key for name in ("state", "transition", "action") for key in schema["$defs"][name]["properties"]}
    if kind == "story":
        step = schema["$defs"]["step"]["properties"]
        wanted |= {*step, *step["expect"]["properties"]}
    if kind == "motion":
        wanted |= set(schema["$defs"]["keyframe"]["properties"])
    if kind == "lumen":
        wanted |= set(schema["$defs"]["route"]["properties"])
    assert wanted - written == set()


@pytest.mark.slow
def test_the_story_in_the_documentation_goes_as_it_says(copy: Path) -> None:
    story, *_ = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "stories.md").read_text("utf-8"), re.S)
    (copy / "behaviors" / "stories" / "song.yaml").write_text(story, "utf-8")
    assert main(["test", str(copy), "song"]) == 0


def test_the_schemas_know_every_file_that_the_vocabulary_lists() -> None:
    names = re.findall(r"`(schemas/[a-z]+\.schema\.json)`", VOCABULARY)
    assert names
    for name in names:
        assert (ROOT / name).is_file(), name


def commands(text: str) -> Iterator[list[str]]:
    """Yield the commands between backticks or in indented lines."""
    for found in re.findall(r"`((?:lumen|make|pytest|python) [^`]+)`", text):
        yield found.split()
    for line in text.splitlines():
        if re.match(r" {4}(lumen|make|pytest|python) ", line):
            yield line.split()


def files_of(words: list[str]) -> list[str]:
    """Return the files and folders that python or pytest is given."""
    if words[:2] == ["-m", "pytest"]:
        words = words[2:]
    if words[0] == "-m":
        return [words[1].replace(".", "/")]
    return [words[0], *(word for word in words if word.startswith(("tests/", "benchmarks/")))]


@pytest.mark.parametrize("page", ["change-the-tour.md", "yaml.md", "research.md", "reliability.md", "stories.md"])
def test_the_commands_in_the_documentation_exist(page: str, capsys: pytest.CaptureFixture[str]) -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    for command, *rest in commands((ROOT / "docs" / page).read_text("utf-8")):
        match command:
            case "lumen":
                with pytest.raises(SystemExit, match="0"):
                    main([rest[0], "--help"])
                exists(rest, "--story", ROOT / "behaviors" / "stories")
                if rest[0] == "play":
                    assert (ROOT / "motions" / f"{rest[1]}.yaml").is_file(), rest
            case "make":
                assert f"\n{rest[0]}:" in makefile, rest
            case _:
                for word in files_of(rest):
                    assert (ROOT / word.partition("::")[0]).exists(), rest


def exists(words: list[str], option: str, folder: Path) -> None:
    if option in words:
        name: Any = words[words.index(option) + 1]
        assert (folder / f"{name}.yaml").is_file(), words


def test_the_paper_has_a_row_for_each_figure_table_and_conclusion() -> None:
    lines = [line for line in PAPER.splitlines() if line.startswith("| ")]
    rows = [line for line in lines if not line.startswith(("| paper", "| ---"))]
    figures = {int(n) for row in rows for n in re.findall(r"^\| Fig\. (\d+)", row)}
    assert figures == set(range(1, 18))
    for named in ("Table 1", "Table 2", "The table of the state machine", "Code:", "1. ", "2. ", "3a. ", "4. "):
        assert any(row.startswith(f"| {named}") for row in rows), named
    for row in rows:
        reproduced = re.search(r"`(lumen|make|pytest|python) ", row)
        assert reproduced or "missing" in row or "as Fig." in row, row
