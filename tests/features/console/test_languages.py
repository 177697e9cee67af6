"""The pages in Indonesian: no text is left out, and no text of the console is English there."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import ROOT
from tests.features.console.conftest import Hosted
from tests.features.console.languages import english_on, phrases, texts
from tests.features.console.pages import Served
from tests.features.console.test_pages import PAGES
from tests.features.console.viewer import Viewer
from tests.waiting import HANG, until

CONSOLE = ROOT / "engine/lumen/features/console"
NEVER_ON_A_PAGE = (
    "__init__.py",
    "access.py",
    "command.py",
    "drawing.py",
    "entry_words.py",
    "part.py",
    "people.py",
    "proxies.py",
    "reading.py",
    "rules.py",
    "serving.py",
    "settings.py",
    "spoken_names.py",
)
"""Modules whose messages go to the terminal or a file, or that have their own Indonesian."""
NOTES = ("plays …", "says “…”", "goes into the posture …")
"""The notes that orders write into the journal, which stays in one language."""
PLACES = r"\{(\w+)"


def messages(module: Path) -> Iterator[str]:
    """Yield the reasons that a module gives: sentences without a capital letter; a value is `…`."""
    tree = ast.parse(module.read_text("utf-8"))
    documented = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    inner = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if id(node) in documented | inner:
            continue
        if isinstance(node, ast.JoinedStr):
            text = "".join(str(part.value) if isinstance(part, ast.Constant) else "…" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = node.value
        else:
            continue
        if text.count(" ") > 2 and re.search(r"[a-z]{2,} [a-z]{2,}", text) and not text[0].isupper():
            yield text


def test_both_languages_fill_in_the_same_values() -> None:
    english, indonesian = texts("en"), texts("id")
    assert english.keys() == indonesian.keys()
    for name, text in english.items():
        plain = {*re.findall(PLACES, re.sub(r"\{\w+\|[^}]*\}", "", text))}
        assert plain == {*re.findall(PLACES, indonesian[name])}, name


def test_each_phrase_fills_in_what_it_finds() -> None:
    for english, indonesian in phrases():
        assert {*re.findall(r"\{(\d)", english)} >= {*re.findall(r"\{(\d)", indonesian)}, english


def test_each_reason_of_the_console_has_its_indonesian() -> None:
    known = {re.sub(r"\{\d[#_]?\}", "…", english) for english, _ in phrases()}
    known |= {
        re.sub(r"`…` must be", f"`{name}` must be", one)
        for one in known
        for name in ("go", "on", "now", "keep", "write")
    }
    known |= {
        one.replace("`…` must be one of", f"`{name}` must be one of")
        for one in known
        for name in ("command", "decision", "robot")
    }
    modules = [module for module in CONSOLE.glob("*.py") if module.name not in NEVER_ON_A_PAGE]
    found = {message for module in modules for message in messages(module)}
    assert len(found) > 40
    assert sorted(found - known - {*NOTES}) == []


@pytest.mark.slow
@pytest.mark.parametrize("width", [1400, 360])
@pytest.mark.parametrize("page", [page for page in PAGES if page != "subtitles"])  # they are in the visitor's language
def test_a_page_in_indonesian_shows_no_english(
    viewer: Viewer, served: Served, hosted: Hosted, page: str, width: int
) -> None:
    hosted.send("face", {"x": 160, "y": 120})
    until(lambda: "ask_name" in hosted.exhibition.configuration, HANG)
    hosted.send("heard", {"result": "nama saya Budi", "language": "id"})
    until(lambda: hosted.exhibition.context["visitor"] == "Budi", HANG)
    served.browser.command("mark", text="melambai")
    path, ready = PAGES[page]
    viewer.open(served.console.address, path, ready=ready, language="id", mode="author", width=width)
    assert english_on(viewer) == []


@pytest.mark.slow
def test_a_reason_without_indonesian_is_marked_as_english(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf", language="id", mode="author")
    viewer.run(
        "document.querySelector('.cue .grow input:not(.code)').focus();"
        "import('/pages/commands.js').then(({ command }) => command('NAO', 'goto', { state: 'nowhere' }))"
    )
    viewer.shows("ditolak", ".told")
    viewer.shows("(dalam bahasa Inggris)", ".told")
    assert viewer.run("return document.querySelector('.told [lang=en]').textContent") != ""
