"""Runs that are refused after the project's files were read, which `lumen run` does in another process."""

import shutil
from pathlib import Path

from tests.golden.command_line import lumen, workplace
from tests.golden.golden import PROJECTS

SUITE = "rest"
CALLS = (
    ("minimal", "--story", "visito"),
    ("minimal", "--language", "de"),
    ("minimal", "--bus", "http://x"),
    ("minimal", "--for", "5", "--story", "visitor"),
    ("broken", "--robot", "recording", "--speed", "max", "--story", "visitor"),
)


def record(folder: Path) -> None:
    """Write how each call ends."""
    texts = []
    with workplace() as work:
        for name in ("minimal", "broken"):
            shutil.copytree(PROJECTS / "minimal", work / name)
        file = work / "broken/lumen.yaml"
        file.write_text(file.read_text("utf-8").replace("story: visitor", "story: visiter"), "utf-8")
        texts.extend(f"$ lumen run {' '.join(words)}\n{lumen(work, 'run', *words)}" for words in CALLS)
    (folder / "calls.txt").write_text("\n".join(texts), "utf-8")
