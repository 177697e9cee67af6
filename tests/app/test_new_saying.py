"""A saying that the console adds: one entry more in behaviors/sayings/day.yaml, and nothing else is touched."""

import os
from difflib import unified_diff
from pathlib import Path

import pytest
import yaml

from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.language.sayings import Saying
from lumen.run.new_saying import DAY_FILE, HEADER, with_saying, write_saying
from tests.explaining.guide import guide_in
from tests.tables import for_each

SAID = Saying("tour", "offer", "not dance|sing", "en", "Please: don't “dance”")
ENTRY = {"tour": {"offer": {"not dance|sing": {"en": ["Please: don't “dance”"]}}}}
BLOCK = """\
# a comment

tour:
  offer:   # a state

    dance: {en: ["Dance!"]}
    not dance|sing:
      # phrases
      id:
        - jangan
      en:
        - {say: don't, n: 2} # an object

  # another state
  ask_name: {my_name: {en: [Budi]}}
"""


def added(text: str, saying: Saying = SAID) -> str:
    """Return the lines that a saying adds to a text; fail if it changes another line."""
    after = with_saying(text.encode(), saying).decode()
    changed = [*unified_diff(text.splitlines(), after.splitlines(), n=0)][3:]
    assert all(line.startswith("+") for line in changed)
    return "\n".join(line[1:] for line in changed)


def test_the_first_one_makes_the_file() -> None:
    text = with_saying(b"", SAID).decode()
    assert yaml.safe_load(text) == ENTRY
    assert text.startswith(f"{HEADER}\n\ntour:\n  offer:\n    not dance|sing:\n      en:\n        - \"Please: don't")
    assert with_saying(b"# by hand", SAID).decode() == f"# by hand\n{text.partition(HEADER)[2][1:]}"


@for_each(
    ("text", "line"),
    [
        (BLOCK, "        - \"Please: don't “dance”\""),
        (BLOCK.replace("en:\n        - {say: don't, n: 2} # an object", "de: [nein]"),
         "      en:\n        - \"Please: don't “dance”\""),
        (BLOCK.replace("not dance|sing:", "no:"),
         "    not dance|sing:\n      en:\n        - \"Please: don't “dance”\""),
        (BLOCK.replace("  offer:", "  choice:"),
         "  offer:\n    not dance|sing:\n      en:\n        - \"Please: don't “dance”\""),
        (BLOCK.replace("tour:", "guide:"),
         "tour:\n  offer:\n    not dance|sing:\n      en:\n        - \"Please: don't “dance”\""),
        (BLOCK.replace("\n", "\r\n"), "        - \"Please: don't “dance”\""),
        (BLOCK.rstrip(), "        - \"Please: don't “dance”\""),
    ],
)  # fmt: skip
def test_one_more_is_a_line_of_its_own_in_its_place(text: str, line: str) -> None:
    assert added(text) == line


@for_each(
    ("text", "entry"),
    [
        ("tour: {offer: {not dance|sing: {en: [no, ]}}}", ', "Please: don\'t “dance”"'),
        ("tour: {offer: {not dance|sing: {id: [no]}}}", ', en: ["Please: don\'t “dance”"]'),
        ("tour: {offer: {dance: {id: [no]}}}", ', not dance|sing: {en: ["Please: don\'t “dance”"]}'),
        ("{tour: {bye: {dance: {id: [no]}}}}\n", ', offer: {not dance|sing: {en: ["Please: don\'t “dance”"]}}'),
        ("tour:\n  offer:\n    not dance|sing: {en: [\n      no\n    ]}\n", ', "Please: don\'t “dance”"'),
    ],
)
def test_between_brackets_it_stands_behind_the_last(text: str, entry: str) -> None:
    after = with_saying(text.encode(), SAID).decode()
    assert after.replace(entry, "") == text
    assert after.count(entry) == 1


@for_each("key", ["no", "null", "a b", "12", "x: y", "#a", "sì", "heard 'it'"])
def test_keys_and_texts_mean_what_was_said(key: str) -> None:
    for text in (b"", b"tour: {offer: {dance: {en: [a]}}}\n", b"tour:\n  offer:\n    dance:\n      en:\n        - a\n"):
        for said in ("1e3", "0o17", "no", "null", "- a", '"', "\\", "# a", "a: b", "{", "sì 😀"):
            with_saying(text, Saying("tour", "offer", key, "en", said))  # it compares what is read then


def test_what_is_there_stays_as_it_is() -> None:
    once = with_saying(BLOCK.encode(), SAID)
    assert with_saying(once, SAID) == once


@for_each(
    "text",
    [
        "tour: &a {offer: {not dance|sing: {en: &b [no]}, bye: {else: {en: *b}}}}",
        "tour:\n  offer:\n    not dance|sing:\n      en: &all\n        - no\n    else: {en: *all}\n",
        "- tour\n",
        "{}\n",
        "tour: [\n",
    ],
)
def test_where_no_place_is_found_it_says_so(text: str) -> None:
    with pytest.raises(UsageError, match=r"by hand"):
        with_saying(text.encode(), SAID)


CHOICE = Saying("guide", "choice", "dance", "en", " please   dance\n")


def test_a_saved_one_is_tried_with_the_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = guide_in(tmp_path, other="guide: {choice: {else: {en: [hello]}}}\n")
    assert write_saying(root, CHOICE) == Path(DAY_FILE)
    file = root / DAY_FILE
    assert yaml.safe_load(file.read_text("utf-8")) == {"guide": {"choice": {"dance": {"en": ["please dance"]}}}}
    file.chmod(0o600)
    write_saying(root, Saying("guide", "choice", "no|done", "id", "sudah"))
    assert file.stat().st_mode & 0o777 == 0o600
    assert sorted(os.listdir(file.parent)) == ["day.yaml", "other.yaml"]
    assert main(["test", str(root)]) == 0
    assert "sayings: 3 of 3" in capsys.readouterr().out


@for_each(
    ("saying", "message"),
    [
        (Saying("guide", "choice", "danse", "en", "dance"), "has no row `danse` (did you mean `dance`?"),
        (Saying("guide", "chioce", "dance", "en", "dance"), "no state `chioce`"),
        (Saying("giude", "choice", "dance", "en", "dance"), "no behaviour `giude`"),
        (Saying("guide", "choice", "dance", "fr", "danse"), "does not speak `fr`"),
        (Saying("guide", "choice", "dance", "", "dance"), "`language` must be a code such as `en`"),
        (Saying("guide", "choice", "dance", "en", "?"), "`text` must be a string of 1 to 1000 characters"),
    ],
)
def test_what_lint_would_refuse_is_not_written(tmp_path: Path, saying: Saying, message: str) -> None:
    root = guide_in(tmp_path)
    with pytest.raises(UsageError) as refused:
        write_saying(root, saying)
    assert message in str(refused.value)
    assert not (root / DAY_FILE).exists()


@for_each(
    ("text", "message"),
    [
        ("guide: [\n", r"day.yaml, line 1: .*: correct that first"),
        ("guide: {choice: {danse: {en: [a]}}}\n", r"day.yaml, line 1: .*no row `danse`.*: correct that first"),
        ("guide: {choice: {dance: {en: a}}}\n", r"day.yaml, line 1: .*brackets.*: correct that first"),
    ],
)
def test_a_file_with_errors_is_left_alone(tmp_path: Path, text: str, message: str) -> None:
    root = guide_in(tmp_path, day=text)
    with pytest.raises(UsageError, match=message):
        write_saying(root, CHOICE)
    assert (root / DAY_FILE).read_text("utf-8") == text


def test_errors_of_other_files_do_not_matter(tmp_path: Path) -> None:
    root = guide_in(tmp_path, other="guide: {choice: {danse: {en: [a]}}}\n")
    assert write_saying(root, CHOICE) == Path(DAY_FILE)


def test_nothing_is_written_through_a_link(tmp_path: Path) -> None:
    root = guide_in(tmp_path / "here")
    kept = root / "kept.yaml"
    kept.write_text("guide: {choice: {dance: {en: [a]}}}\n", "utf-8")
    (root / DAY_FILE).symlink_to(kept)
    with pytest.raises(UsageError, match="a symbolic link"):
        write_saying(root, CHOICE)
    assert kept.read_text("utf-8") == "guide: {choice: {dance: {en: [a]}}}\n"
