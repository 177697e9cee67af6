"""The home of a run that was killed in a visit, and how a start continues from it, after various times.

The first file lists the home; the second has states, context, timers and commands after each start.
"""

import json
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import lumen
from tests.golden.adapters import recovered
from tests.golden.golden import HERE, PROJECTS
from tests.golden.texts import in_one_line, write

SUITE = "test"
HOME = HERE / "homes" / "tour"
AGES = (-2.0, 0.0, 5.0, 31.0, 599.0, 601.0, 7200.0)
"""Times of a start after the last sign of life of the run [s]."""


def record(folder: Path) -> None:
    """Write both files."""
    write(folder / "home.txt", contents())
    ended = json.loads((HOME / "alive.json").read_text("utf-8"))["time"]
    lines = []
    with TemporaryDirectory() as temporary:
        root = put(Path(temporary))
        project = lumen.load(root)
        for age in AGES:
            lines += [f"{age:g} s later", *recovered(root, project, ended + age)]
        for name in ("alive.json", "snapshot.json"):
            (root / ".lumen" / name).write_text("{", "utf-8")
            lines += [f"{name} is damaged", *recovered(root, project, ended + 5)]
    write(folder / "starts.txt", lines)


def put(folder: Path) -> Path:
    """Write a copy of the project, with that home, into `folder`; return it."""
    root = folder / "tour"
    shutil.copytree(PROJECTS / "tour", root)
    shutil.copytree(HOME, root / ".lumen")
    return root


def contents() -> list[str]:
    """Return the files of the home with their sizes, and the content of those that are JSON."""
    lines = []
    for file in sorted(path for path in HOME.rglob("*") if path.is_file()):
        data = file.read_bytes()
        lines.append(f"{file.relative_to(HOME)} {len(data)} bytes")
        if file.suffix in (".json", ".jsonl"):
            lines += [f"  {in_one_line(json.loads(line))}" for line in data.splitlines() if line.strip()]
    return lines
