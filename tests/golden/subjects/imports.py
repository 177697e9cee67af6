"""The output and the findings of `lumen import` for files of other tools: the inputs of tests/formats, and robots."""

import json
import shutil
from pathlib import Path
from typing import Any

from tests.golden.command_line import lumen, workplace
from tests.golden.found import write_json
from tests.golden.golden import HERE, PROJECTS

SUITE = "test"
INPUTS = HERE / "imports"
KINDS = ("scxml", "xstate", "gesture", "fll", "fcl", "fis", "robot")


def record(folder: Path) -> None:
    """For each kind of file write the findings, their words, and the files that are written."""
    with workplace() as work:
        shutil.copytree(PROJECTS / "tour", work / "tour")
        for kind in KINDS:
            rows = json.loads((INPUTS / f"{kind}.json").read_text("utf-8"))
            assert rows, f"no inputs of {kind}"
            _record(folder, work, kind, rows)


def _record(folder: Path, work: Path, kind: str, rows: dict[str, Any]) -> None:
    found, words, written = {}, {}, []
    for name, row in rows.items():
        file, out = work / row["file"], work / "out.yaml"
        file.write_text(row["text"], "utf-8", newline="")
        given = ["--timeline", row["timeline"]] if "timeline" in row else []
        given += ["-o", out.name] if kind != "robot" else []  # a URDF would be converted by MuJoCo as well
        outcome = lumen(work, "import", row["file"], "--project", "tour", "--format", "json", *given)
        diagnostics, said = _read(outcome.err)
        found[name] = [outcome.code, *(_finding(one) for one in diagnostics)]
        words[name] = [*said, *([one["message"], one["hint"]] for one in diagnostics)]
        text = out.read_text("utf-8") if out.exists() else outcome.out
        written += [f"# ---- {name}\n{text}"] if text else []
        out.unlink(missing_ok=True)
        file.unlink()
    write_json(folder / f"{kind}.findings.json", found)
    write_json(folder / f"{kind}.words.json", {name: lines for name, lines in words.items() if lines})
    (folder / f"{kind}.yaml").write_text("".join(written), "utf-8")


def _read(error: str) -> tuple[list[dict[str, Any]], list[str]]:
    """Return the diagnostics of standard error, and its other lines."""
    if not error.startswith("{"):
        return [], error.splitlines()
    data, end = json.JSONDecoder().raw_decode(error)
    return data["diagnostics"], error[end:].split("\n")[1:-1]


def _finding(one: dict[str, Any]) -> str:
    related = [f"{other['file']}:{other['line']}:{other['column']}" for other in one["related"]]
    place = f"{one['file']}:{one['line']}:{one['column']}-{one['end_line']}:{one['end_column']}"
    return f"{one['severity']} {one['code']} {place}{' | ' if related else ''}{', '.join(related)}"
