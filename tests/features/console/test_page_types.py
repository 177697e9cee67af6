"""The code of the console's pages, checked by TypeScript: types are comments of it, and nothing is compiled."""

from pathlib import Path

from tests import ROOT
from tests.fetched import fetched
from tests.guarded import run_guarded


def faults(config: Path) -> list[str]:
    """The faults that TypeScript finds by this configuration."""
    compiler = fetched("typescript") / "node_modules/typescript/bin/tsc"
    line = ["node", str(compiler), "--project", str(config), "--pretty", "false"]
    done = run_guarded(line, cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    return done.stdout.splitlines()


def test_the_types_of_the_pages_agree() -> None:
    assert faults(ROOT / "tsconfig.json") == []
