"""The third-party files of the console's pages equal those on npm, and have their licences."""

import re

import pytest

from tests import ROOT
from tests.fetched import fetched

PAGES = ROOT / "engine/lumen/features/console/pages"
CARRIED = {
    "htm-preact.js": "htm/preact/standalone.module.js",
    "htm.LICENSE": "htm/LICENSE",
    "three.js": "three/build/three.module.min.js",
    "three.LICENSE": "three/LICENSE",
}


@pytest.mark.parametrize("name", CARRIED)
def test_a_file_of_others_is_what_npm_has(name: str) -> None:
    assert (PAGES / "vendor" / name).read_bytes() == (fetched("console") / CARRIED[name]).read_bytes()


def test_all_that_is_carried_is_said() -> None:
    said = (PAGES / "vendor/README.md").read_text(encoding="utf-8")
    assert [file.name for file in (PAGES / "vendor").iterdir() if f"`{file.name}`" not in said] == ["README.md"]


def test_pages_ask_nobody_else_and_write_nothing_inline() -> None:
    """The pages contain no other hosts, inline scripts or styles, or markup made from text."""
    refused = (
        "https://",
        "http://",
        "innerHTML",
        "dangerouslySet",
        "insertAdjacentHTML",
        "eval(",
        "style=",
        "onclick=",
    )
    own = [
        file for file in PAGES.rglob("*.*") if file.suffix in (".js", ".css", ".html") and file.parent.name != "vendor"
    ]
    assert [f"{file.name}: {word}" for file in own for word in refused if word in file.read_text("utf-8")] == []


def test_both_languages_say_the_same_things() -> None:
    names = [re.findall(r'"([\w. -]+)": "', (PAGES / f"texts/{code}.js").read_text("utf-8")) for code in ("en", "id")]
    assert names[0] == names[1]
    assert len(names[0]) > 200
