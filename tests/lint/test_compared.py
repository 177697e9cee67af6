"""docs/lint-compared.md shows what lint reports today; the benchmark prints the reports of other tools."""

import re

from benchmarks.compare_lint import PROJECT, Mistake, cell, mistakes

from lumen.lint import check_files
from lumen.project.files import read_files
from tests import ROOT
from tests.tables import for_each

PAGE = (ROOT / "docs/lint-compared.md").read_text("utf-8")


@for_each("mistake", mistakes(), ids=lambda mistake: mistake.what)
def test_the_page_shows_what_lint_says(mistake: Mistake) -> None:
    files = read_files(PROJECT)
    files[mistake.file] = files[mistake.file].decode().replace(mistake.old, mistake.new, 1).encode()
    found = [d for d in check_files(PROJECT, files)[1] if d.place.file == mistake.file]
    said = "; ".join(f"{d.place.line}:{d.place.column} {d.message}{f' ({d.hint})' if d.hint else ''}" for d in found)
    [row] = re.findall(rf"\*\*{re.escape(mistake.what)}\*\*[\s\S]*?\| lumen lint \| (.*) \|\n", PAGE)
    assert row == cell(said, ROOT)
