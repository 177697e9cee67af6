"""The code of the console's pages, checked by TypeScript: types are comments of it, and nothing is compiled."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tests import ROOT
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser
from tests.features.console.test_page_sources import PAGES, sources
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.waiting import until

ANSWERS = {
    "Now": "/api/now",
    "Day": "/api/day?robot=NAO",
    "Entries": "/api/entries?robot=NAO&from=0&to=1000",
    "Chart": "/api/chart?robot=NAO",
    "Files": "/api/files?robot=NAO",
}
"""Types of `types.d.ts`, and the paths whose answers they describe."""


def faults(config: Path) -> list[str]:
    """The faults that TypeScript finds by this configuration."""
    compiler = fetched("typescript") / "node_modules/typescript/bin/tsc"
    line = ["node", str(compiler), "--project", str(config), "--pretty", "false"]
    done = run_guarded(line, cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    return str(done.stdout).splitlines()


def faults_of(code: str, folder: Path) -> list[str]:
    """The faults of a module beside the pages."""
    (folder / "module.ts").write_text(code, encoding="utf-8")
    config = {"extends": str(ROOT / "tsconfig.json"), "include": ["module.ts"], "exclude": []}
    (folder / "tsconfig.json").write_text(json.dumps(config), encoding="utf-8")
    return faults(folder / "tsconfig.json")


def faults_of_answers(answers: Mapping[str, Any], folder: Path) -> list[str]:
    """The faults of answers of the console, each by the name of its type in `types.d.ts`.

    An answer is written as a literal, so a key that its type lacks is a fault too.
    """
    code = f"import type {{ {', '.join(answers)} }} from {json.dumps(str(PAGES / 'types'))};\n"
    for kind, answer in answers.items():
        code += f"export const of{kind}: {kind} = {json.dumps(answer)};\n"
    return faults_of(code, folder)


def test_the_types_of_the_pages_agree() -> None:
    assert faults(ROOT / "tsconfig.json") == []


def test_each_module_is_checked() -> None:
    unchecked = [
        file.name for file in sources(".js") if not file.read_text(encoding="utf-8").startswith("// @ts-check\n")
    ]
    assert unchecked == []


def test_the_types_describe_what_the_server_sends(hosted: Hosted, browser: Browser, tmp_path: Path) -> None:
    hosted.send("heard", {"result": "hello"})
    until(lambda: browser.robots[0].get("visitor_said"))
    assert faults_of_answers({kind: browser.get(path).data for kind, path in ANSWERS.items()}, tmp_path) == []


def test_a_wrong_key_is_found(tmp_path: Path) -> None:
    known = f"import {{ robotOf }} from {json.dumps(str(PAGES / 'live.js'))};\n"
    (found,) = faults_of(f'{known}export const name = robotOf("NAO")?.nmae;\n', tmp_path)
    assert "Property 'nmae' does not exist on type 'Robot'" in found
