"""The page about actions has an entry for each verb, and its examples pass lint and can be played."""

import json
import re

import pytest
from scripts.documented import available, check

from tests import ROOT

PAGE = ROOT / "docs/actions.md"
IN_ANOTHER_ENTRY = {"then", "else"}


def test_the_page_has_an_entry_for_each_verb() -> None:
    schema = json.loads((ROOT / "schemas/behavior.schema.json").read_text("utf-8"))
    verbs = set(schema["$defs"]["action"]["properties"]) - IN_ANOTHER_ENTRY
    headings = set(re.findall(r"(?m)^## (\w+)$", PAGE.read_text("utf-8")))
    assert headings == verbs


def test_each_entry_has_an_example_and_says_when_the_action_ends() -> None:
    entries = re.split(r"(?m)^## ", PAGE.read_text("utf-8"))[1:]
    verbs = {entry.partition("\n")[0]: entry for entry in entries if re.match(r"\w+\n", entry)}
    assert [verb for verb, entry in verbs.items() if "```yaml" not in entry or "**" not in entry] == []


@pytest.mark.process
def test_the_examples_pass_lint_and_are_played_as_the_page_shows() -> None:
    count, wrong, _ = check(PAGE, available() - {"physics", "broker"})
    assert (count, wrong) == (2, [])
