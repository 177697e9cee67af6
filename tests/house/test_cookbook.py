"""The cookbook's recipes pass lint and their stories, and its page shows text that is in their files."""

import re

import lumen
from lumen.run.rehearsal import rehearse
from tests import ROOT
from tests.scanning import matching

COOKBOOK = ROOT / "examples/cookbook"
DUET = ROOT / "examples/duet"
BLOCK = re.compile(r"(?m)^```yaml\n([\s\S]*?)^```$")


def unindented(text: str) -> str:
    """Return the lines of a text without their indentation and their comments."""
    return "\n".join(line.partition("   #")[0].strip(" -") for line in text.splitlines())


def test_lint_finds_nothing_in_the_recipes() -> None:
    assert not lumen.check(COOKBOOK)


def test_every_recipe_has_a_story_that_passes() -> None:
    project = lumen.load(COOKBOOK)
    assert {story.behavior for story in project.stories.values()} == set(project.behaviors)
    assert [name for name, story in project.stories.items() if rehearse(project, story).failed] == []


def test_the_page_shows_what_is_in_the_files() -> None:
    files = [unindented(file.read_text("utf-8")) for root in (COOKBOOK, DUET) for file in matching(root, "**/*.yaml")]
    shown = BLOCK.findall((ROOT / "docs/cookbook.md").read_text("utf-8"))
    assert len(shown) > 12
    assert [block for block in shown if not any(unindented(block).strip() in file for file in files)] == []
