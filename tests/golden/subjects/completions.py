"""The completion scripts of bash, zsh and fish, and their completions."""

import shutil
from pathlib import Path

from tests.golden.adapters_language import verbs
from tests.golden.command_line import lumen, workplace
from tests.golden.found import write_json
from tests.golden.golden import PROJECTS

SUITE = "test"
SHELLS = ("bash", "zsh", "fish")
BEGUN = (
    "li", "no-such-verb ", "lint ", "lint --st", "lint --strict --st", "lint --format ", "lint --select sp",
    "run --story v", "run --speed ", "run --robot ", "run --language ", "run --only ", "test shy vis",
    "play ", "play dance ",
    "explain unknown-st", "explain sp", "topic p", "diff ", "graph ", "graph --state go", "graph --region ",
    "export ", "export scxml ", "export fll ", "goto ", "say ", "why ", "memory ", "language ", "fleet ", "schema m",
    "new --like ", "completion ", "reload ", "import ", "plot ", "--ve", "run --frobnicate ", "lint -- ",
)  # fmt: skip
"""The words typed after `lumen` in the tour when Tab is pressed; besides each verb alone, and `--` behind it."""


def record(folder: Path) -> None:
    """Write each script, and the words that complete a line, with their meaning."""
    lines = ["", *(f"{verb} --" for verb in verbs() if verb != "lumen"), *BEGUN]
    with workplace() as work:
        shutil.copytree(PROJECTS / "tour", work, dirs_exist_ok=True)
        for shell in SHELLS:
            (folder / f"lumen.{shell}").write_text(lumen(work, "completion", shell).out, "utf-8")
        write_json(folder / "completed.json", {f"lumen {line}": _completed(work, line) for line in lines})


def _completed(work: Path, line: str) -> list[str]:
    outcome = lumen(work, "completion", "words", *(f".{word}" for word in line.split(" ")))
    assert outcome.code == 0, outcome
    return [found.replace("\t", "  ") for found in outcome.out.splitlines()]
