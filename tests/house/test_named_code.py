"""The page for people who change the engine names functions and classes that exist, in the files that it names."""

import re

from tests import ROOT
from tests.tables import for_each

PAGE = " ".join((ROOT / "docs/architecture.md").read_text("utf-8").split())
NAMED = {
    *re.findall(r"`([A-Za-z_.]+)`,? (?:in|of) `([a-z_/]+\.py)`", PAGE),
    *((name, file) for file, name in re.findall(r"`([a-z_/]+\.py)`: `([A-Za-z_.]+)`", PAGE)),
}


def test_the_page_names_code_in_both_forms() -> None:
    assert {("Node.tick", "run/node.py"), ("Inbox.listen", "run/inbox.py")} <= NAMED


@for_each(("name", "file"), sorted(NAMED))
def test_what_the_page_names_is_in_that_file(name: str, file: str) -> None:
    code = next(path for path in (ROOT / "engine/lumen" / file, ROOT / file) if path.exists()).read_text("utf-8")
    for part in name.split("."):
        assert re.search(rf"(?m)\b(def|class) {part}\b|^ *{part}\b.* = |^ *\"{part}\":", code), f"{file} has no {part}"
