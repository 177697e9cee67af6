"""The extension of VS Code, as it is built: its language client, in node, against the real server."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

from lumen.run.exhibition import Exhibition
from tests import ROOT
from tests.cli.conftest import bus, copy, exhibition, project
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.provided import program
from tests.scanning import matching
from tests.waiting import HANG

__all__ = ["bus", "copy", "exhibition", "project"]
COMMAND = [sys.executable, "-m", "lumen"]
TOUR = "behaviors/tour.yaml"


@pytest.fixture(scope="module")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extension's folder in the package that `scripts/vsix.py` builds."""
    fetched("vscode")
    folder = tmp_path_factory.mktemp("vscode")
    run_guarded(
        [sys.executable, ROOT / "scripts/vsix.py", "--output", folder / "lumen.vsix"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    with zipfile.ZipFile(folder / "lumen.vsix") as archive:
        archive.extractall(folder)
    return folder / "extension"


def hosted(extension: Path, root: Path, file: str, *more: str) -> dict[str, Any]:
    """Run the extension in an editor that has this file open, and return what it did."""
    words = [ROOT / "tests/features/editor/vscode_host.js", extension, root, json.dumps(COMMAND), root / file, *more]
    done = run_guarded([program("node", "npm"), *words], capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    return dict(json.loads(done.stdout))


def test_it_holds_what_it_needs_and_says_what_it_is(extension: Path) -> None:
    data = json.loads((extension / "package.json").read_text("utf-8"))
    assert (extension / data["main"]).is_file()
    assert (extension / "LICENSE").read_text("utf-8") == (ROOT / "LICENSE").read_text("utf-8")
    installed = json.loads((extension / "node_modules/vscode-languageclient/package.json").read_text("utf-8"))
    assert installed["version"] == data["dependencies"]["vscode-languageclient"]
    assert data["version"] == "0.1.0"
    assert not [file for file in matching(extension, "**/*") if file.name.endswith(".d.ts")]


def test_a_lens_runs_a_story_in_a_terminal_of_the_project(extension: Path) -> None:
    said = hosted(extension, ROOT, "behaviors/stories/visitor.yaml")
    assert said["terminals"] == [[str(ROOT), f"{' '.join(COMMAND)} test visitor"]]
    assert list(said["diagnostics"].values()) == [[]]
    assert {"lumen.restart", "lumen.runStory", "lumen.playMotion", "lumen.showPlaces"} <= set(said["commands"])


@pytest.mark.slow
def test_it_marks_where_a_running_exhibition_is_and_lists_transitions(
    extension: Path, exhibition: Exhibition, copy: Path
) -> None:
    text = (copy / TOUR).read_text("utf-8").split("\n")
    said = hosted(extension, copy, TOUR, "decorated")
    marked = next(lines for lines in said["decorated"] if lines)
    assert {"idle:", "watching:"} <= {text[line].split()[0] for line in marked}
    [(shown, count)] = said["shown"]
    first = next(lens for lens in said["lenses"] if lens["command"] == "lumen.showPlaces")
    assert (shown, f"{count} transitions lead here") == ("editor.action.showReferences", first["title"])


def test_no_name_of_a_file_is_a_command_of_a_shell() -> None:
    script = "console.log(require(process.argv[1]).commandLine(['a b/lumen'], 'test', process.argv[2]))"
    terminal = ROOT / "editors/vscode/terminal.js"
    node = program("node", "npm")
    good = run_guarded([node, "-e", script, terminal, "visitor"], capture_output=True, text=True)
    assert good.stdout == '"a b/lumen" test visitor\n'
    bad = run_guarded([node, "-e", script, terminal, "visitor; rm"], capture_output=True, text=True)
    assert "is no name of a story or motion" in bad.stderr
