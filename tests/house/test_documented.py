"""The commands in the documentation can be typed. `make docs` runs them all; this is the quick part."""

import argparse
import importlib
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
from scripts.documented import ROOT, all_pages, available, check, differing, missing

from lumen.cli.intermixed import Intermixed
from lumen.cli.main import subcommands
from tests.tables import for_each

BLOCK = re.compile(r"(?m)^```[\s\S]*?^```$")


def commands(page: Path) -> Iterator[str]:
    """Yield every `lumen …` of a page: between backticks, in an indented line, behind a `$`."""
    text = page.read_text(encoding="utf-8")
    yield from re.findall(r"(?m)^\$ (lumen .*)$", text)
    prose = BLOCK.sub("", text)
    yield from re.findall(r"`(lumen [^`\n]+)`", prose)
    yield from re.findall(r"(?m)^ {4}(lumen .*)$", prose)


def can_be_typed(command: str) -> bool:
    """Return whether a verb's own parser accepts the rest of a command, with a number for a placeholder in capitals."""
    words = shlex.split(re.split(r" [|>&] ?| && |;| 2>", command)[0], comments=True)[1:]
    words = ["1" if re.fullmatch("[A-Z]+", word) else word for word in words if not word.startswith("…")]
    if not words or words[0].startswith("-") or words[0] == "1":
        return True
    if words[0] not in subcommands():
        return False
    parser = Intermixed()
    importlib.import_module(subcommands()[words[0]].module).configure(parser)
    try:
        parser.parse_args(words[1:])
    except SystemExit as end:
        return end.code == 0 or len(words) == 1
    except argparse.ArgumentError:
        return False
    return True


@for_each("page", all_pages(), ids=lambda page: page.name)
def test_every_command_of_a_page_is_one_that_lumen_takes(page: Path) -> None:
    assert [command for command in commands(page) if not can_be_typed(command)] == []


@pytest.mark.process
def test_what_the_tutorial_shows_is_printed() -> None:
    count, wrong, _ = check(ROOT / "docs/change-the-tour.md", available() - {"physics", "broker"})
    assert (count > 0, wrong) == (True, [])


@for_each(
    ("shown", "printed", "is_same"),
    [
        ("3 errors in 1 file", "3 errors in 1 file", True),
        ("70 files checked", "80 files checked", True),
        ("70 files checked", "700 files checked", False),
        ("0.5 s, 2.5 px, 1,163 words", "0.7 s, 2.9 px, 1,170 words", True),
        ("0.5 s, 2.5 px, 1,163 words", "0.5 s, 25.0 px, 1,163 words", False),
        ("0.5 s, 2.5 px, 1,163 words", "0.5 s, 2.5 px, 11,630 words", False),
        (" 0:02.1  robot  “Hello”", " 0:02.3 robot “Hello”", True),
        (" 0:02.1  robot  “Hello”", " 0:02.1 robot “Bye”", False),
        ("robot “…”", "robot “anything 3”", True),
        ("a\n…\nd", "a\nb\nc\nd", True),
        ("a\n…\nd", "a\nb\nc", False),
        ("a", "a\nb", False),
        ("a\n…", "a\nb", True),
        ("a (b)?", "a (b)?", True),
        ("behaviors/tour.yaml:231", "behaviors/tour.yaml:231", True),
        ("behaviors/tour.yaml:231", "behaviors/tour.yaml:230", False),
        ("tour.yaml:231:7: error", "tour.yaml:231:8: error", False),
        ("… (tour.yaml:231:7)", "was (tour.yaml:231:7)", True),
    ],
)
def test_an_output_is_compared_with_a_tolerance(shown: str, printed: str, is_same: bool) -> None:
    assert (differing(shown.splitlines(), printed.splitlines()) is None) is is_same


@for_each(
    ("shown", "is_there"),
    [
        (" 0:09.0  reload   done\n 0:01.0  robot    rests", True),
        (" 0:01.0  robot    wakes", False),
        ("a.yaml:3:1 is wrong", True),
        ("a.yaml:4:1 is wrong", False),
    ],
)
def test_of_a_script_in_real_time_the_lines_are_compared_without_their_times(shown: str, is_there: bool) -> None:
    printed = [" 0:01.0  robot    rests", " 0:02.0  reload   done", "a.yaml:3:1 is wrong"]
    assert (missing(shown.splitlines(), printed) is None) is is_there
