"""The sources of the console's pages: short lines, one layout of code and CSS, and the rules of ESLint."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

from tests import ROOT
from tests.fetched import fetched
from tests.guarded import run_guarded

PAGES = ROOT / "engine/lumen/features/console/pages"
EXAMPLES = ROOT / "tests/features/console/examples"
OTHERS, TEXTS = PAGES / "vendor", PAGES / "texts"
LONGEST = 120
STRING = re.compile(r'"(?:[^"\\]|\\.)*"')


def sources(*endings: str) -> Iterator[Path]:
    """The files of our own with one of these endings, of the pages and of the examples."""
    for file in sorted([*PAGES.rglob("*"), *EXAMPLES.iterdir()]):
        if file.suffix in endings and OTHERS not in file.parents:
            yield file


def test_no_line_is_longer_than_120_characters() -> None:
    """A text of a page may be longer, on one line with its name: a search would not find a divided sentence."""
    long = [
        f"{file.relative_to(ROOT)}:{number}"
        for file in sources(".js", ".css")
        for number, line in enumerate(file.read_text("utf-8").splitlines(), 1)
        if len(line) > LONGEST and not (TEXTS in file.parents and len(STRING.findall(line)) <= 2)
    ]
    assert long == []


def test_code_and_css_have_the_layout_of_prettier() -> None:
    prettier = fetched("yaml") / "node_modules/prettier/bin/prettier.cjs"
    files = [str(file.relative_to(ROOT)) for file in sources(".js", ".css") if TEXTS not in file.parents]
    line = ["node", str(prettier), "--config", ".prettierrc.yaml", "--list-different", *files]
    done = run_guarded(line, cwd=ROOT, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("", "")


def test_code_keeps_the_rules_of_eslint() -> None:
    """The types are checked in test_page_types.py."""
    eslint = fetched("eslint") / "node_modules/eslint/bin/eslint.js"
    line = ["node", str(eslint), "--max-warnings", "0", "--format", "json", str(PAGES), str(EXAMPLES)]
    done = run_guarded(line, cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    files = json.loads(done.stdout)
    found = [f"{file['filePath']}:{one['line']}: {one['message']}" for file in files for one in file["messages"]]
    assert found == []
    assert {file["filePath"] for file in files} == {str(file) for file in sources(".js")}
