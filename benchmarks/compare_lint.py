"""Print the table of docs/lint-compared.md: ten mistakes, and the findings of each checker.

The other checkers are those available to a YAML author. check-jsonschema, the YAML language server and Spectral get
Lumen's schemas, so they know every key. ESPHome checks its own kind of project with a corresponding mistake. Give
their folders:

    python benchmarks/compare_lint.py --python VENV --node FOLDER

with `pip install check-jsonschema esphome` in VENV and `npm install yaml-language-server @stoplight/spectral-cli` in
FOLDER. This repository contains none of them; the column of a missing one is empty.
"""

import argparse
import json
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import yaml

ROOT = Path(__file__).parents[1]
PROJECT = ROOT / "tests/golden/projects/tour"
"""A tour that never changes, so that the mistakes stay the same."""
sys.path[:0] = [str(ROOT), str(ROOT / "engine")]

from tests.features.editor.client import Client  # noqa: E402
from tests.guarded import CompletedProcess, run_guarded  # noqa: E402

from lumen.lint import check_files  # noqa: E402
from lumen.project.files import read_files  # noqa: E402
from lumen.project.project_folders import PROJECT_FOLDERS  # noqa: E402

TOUR, GOODBYE, MAIN = "behaviors/tour.yaml", "motions/goodbye.yaml", "lumen.yaml"
KINDS = {TOUR: "behavior", GOODBYE: "motion", MAIN: "lumen"}
ESPHOME = """esphome:
  name: stand
host:
logger:
script:
  - id: greet
    then:
      - logger.log: Good morning
  - id: tour
    then:
      - script.execute: greet
      - delay: 20s
"""


class Mistake(NamedTuple):
    """A mistake: the old and new text in a file of Lumen's, and in ESPHome's project if that can have it."""

    what: str
    file: str
    old: str
    new: str
    theirs: list[str] | None = None


def mistakes() -> list[Mistake]:
    """Return the mistakes of mistakes.yaml."""
    rows = yaml.safe_load((Path(__file__).parent / "mistakes.yaml").read_text("utf-8"))
    return [Mistake(r["what"], r["file"], r["old"], r["new"], r.get("esphome")) for r in rows]


def project(mistake: Mistake, folder: Path) -> dict[str, bytes]:
    """Write a tour with the mistake, and the schemas, to a folder; return its files."""
    shutil.copy(PROJECT / MAIN, folder)
    for name in PROJECT_FOLDERS:
        if (PROJECT / name).is_dir():
            shutil.copytree(PROJECT / name, folder / name)
    shutil.copytree(ROOT / "schemas", folder / "schemas", dirs_exist_ok=True)
    text = (folder / mistake.file).read_text("utf-8")
    assert mistake.old in text, mistake.what
    (folder / mistake.file).write_text(text.replace(mistake.old, mistake.new, 1), "utf-8")
    return read_files(folder)


def ours(mistake: Mistake, folder: Path) -> str:
    """Return the findings of `lumen lint`."""
    found = [d for d in check_files(folder, read_files(folder))[1] if d.place.file == mistake.file]
    return "; ".join(f"{d.place.line}:{d.place.column} {d.message}{f' ({d.hint})' if d.hint else ''}" for d in found)


def check_jsonschema(mistake: Mistake, folder: Path, tool: Path) -> str:
    """Return the errors of check-jsonschema."""
    schema = folder / "schemas" / f"{KINDS[mistake.file]}.schema.json"
    done = run([tool, "--schemafile", schema, "-o", "json", folder / mistake.file], folder)
    try:
        found = json.loads(done.stdout)
    except ValueError:
        return done.stdout + done.stderr
    return "; ".join(
        [f"{e['path']}: {e['message']}" for e in found.get("errors", ())]
        + [f"{e.get('message', e)}" for e in found.get("parse_errors", ())]
    )


def spectral(mistake: Mistake, folder: Path, tool: Path) -> str:
    """Return the errors of Spectral."""
    rules = folder / "rules.json"
    schema = json.loads((folder / "schemas" / f"{KINDS[mistake.file]}.schema.json").read_text("utf-8"))
    then = {"function": "schema", "functionOptions": {"schema": schema, "allErrors": True}}
    rules.write_text(json.dumps({"rules": {"fits": {"given": "$", "severity": "error", "then": then}}}))
    done = run([tool, "lint", folder / mistake.file, "--ruleset", rules, "-f", "json", "-q"], folder)
    try:
        found = json.loads(done.stdout[: done.stdout.rindex("]") + 1])
    except ValueError:
        return done.stdout + done.stderr
    return "; ".join(
        f"{e['range']['start']['line'] + 1}:{e['range']['start']['character'] + 1} {e['message']}" for e in found
    )


def language_server(mistake: Mistake, folder: Path, tool: Path) -> str:
    """Return the diagnostics of the YAML language server."""
    with Client(folder, ["node", str(tool), "--stdio"]) as client:
        client.open(mistake.file)
        found = client.diagnostics(mistake.file)
    places = ((d["range"]["start"], d["message"]) for d in found)
    return "; ".join(f"{at['line'] + 1}:{at['character'] + 1} {message}" for at, message in places)


def esphome(mistake: Mistake, folder: Path, tool: Path) -> str | None:
    """Return ESPHome's messages; None if its kind of project can't have the mistake."""
    if mistake.theirs is None:
        return None
    old, new = mistake.theirs
    assert old in ESPHOME, mistake.what
    (folder / "stand.yaml").write_text(ESPHOME.replace(old, new, 1))
    done = run([tool, "config", folder / "stand.yaml"], folder)
    lines = [line.strip() for line in (done.stdout + done.stderr).splitlines()]
    lines = [line for line in lines if line and not line.startswith("INFO")]
    said = [line for line in lines if re.match(r"ERROR|[A-Z\[][^:]* .*[.\]\"?]$|in \"|found |expected ", line)]
    return "" if done.returncode == 0 else " ".join(said or lines)


def run(words: list[object], folder: Path) -> CompletedProcess[str]:
    """Run a checker in a folder; return its output."""
    environment = {**os.environ, "NO_COLOR": "1", "HOME": str(folder)}
    command = [str(word) for word in words]
    return run_guarded(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False)


def cell(text: str | None, folder: Path) -> str:
    """Return the messages as a cell of a table."""
    if text is None:
        return "–"
    text = re.sub(r"\x1b\[[0-9;]*m", "", text).replace(f"{folder}/", "").replace(str(folder), "")
    text = " ".join(text.replace("|", "\\|").split())
    return (text if len(text) <= 230 else f"{text[:228]} …") or "nothing"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--python", type=Path, default=Path("none"), help="a virtual environment with the peers")
    parser.add_argument("--node", type=Path, default=Path("none"), help="a folder with their node_modules")
    options = parser.parse_args()
    scripts, modules = options.python.absolute() / "bin", options.node.absolute() / "node_modules"
    peers: dict[str, tuple[Path, Callable[[Mistake, Path, Path], str | None]]] = {
        "check-jsonschema": (scripts / "check-jsonschema", check_jsonschema),
        "YAML language server": (modules / "yaml-language-server/bin/yaml-language-server", language_server),
        "Spectral": (modules / ".bin/spectral", spectral),
        "ESPHome": (scripts / "esphome", esphome),
    }
    for number, mistake in enumerate(mistakes(), 1):
        print(f"{number}. **{mistake.what}**\n")
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name).resolve() / "p"
            folder.mkdir()
            project(mistake, folder)
            print(f"   | | |\n   | --- | --- |\n   | lumen lint | {cell(ours(mistake, folder), folder)} |")
            for peer, (tool, ask) in peers.items():
                said = cell(ask(mistake, folder, tool), folder) if tool.exists() else ""
                print(f"   | {peer} | {said} |", flush=True)
        print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
