"""Pin what is installed: the requirements*.txt, each package by its version and its files' hashes.

    python -m pip install uv && python scripts/pin.py

requirements-core.txt is what pyproject.toml asks for without any extra, with what builds the package; requirements.txt
adds the simulation and the plots; requirements-no-deps.txt is dm-control where what it asks for is not to be had.
Versions that are there stay unless pyproject.toml forbids them by now: edit one there, or delete its lines to get the
newest. Of requirements-test.txt and requirements-docs.txt nothing is resolved (their heads say why). The hashes are
those of all files that the index lists for a version, for whatever machine they are.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
CORE, WHOLE, BARE, TEST, DOCS = (
    ROOT / f"requirements{kind}.txt" for kind in ("-core", "", "-no-deps", "-test", "-docs")
)
PYTHON = "3.11"
"""The oldest that Lumen runs on: what is pinned has to run there, too."""
FORM = ("--generate-hashes", "--universal", "--no-header", "--no-annotate", "--quiet", "--python-version", PYTHON)


def main() -> int:
    """Write all files; 1 where one of them could not be."""
    pinned = CORE.read_text() + WHOLE.read_text()
    both = ("pyproject.toml", "--group", "build")
    core = _resolve(pinned, *both)
    whole = _resolve(
        pinned,
        *both,
        "--extra",
        "simulation",
        "--extra",
        "plot",
        "--extra",
        "recording",
        "--extra",
        "console",
        "--extra",
        "fleet",
    )
    if more := [name for name in core if _version(core[name]) != _version(whole[name])]:
        print(
            f"the extras want other versions of {', '.join(more)}: give them bounds in pyproject.toml", file=sys.stderr
        )
        return 1
    _write(CORE, core)
    _write(WHOLE, {name: lines for name, lines in whole.items() if lines != core.get(name)})
    _write(BARE, {"dm-control": whole["dm-control"].replace("< '3.13'", ">= '3.13'")})
    for file in (TEST, DOCS):
        _write(file, _resolve(file.read_text(), file.name, "--no-deps"))
    return 0


def _resolve(pinned: str, *of: str) -> dict[str, str]:
    """The lines of each package of what `of` asks for, where they can, in the versions that are pinned."""
    output = ROOT / "requirements-new.txt"
    output.write_text(_without_head(pinned))
    command = [sys.executable, "-m", "uv", "pip", "compile", *of, *FORM, "--output-file", output.name]
    try:
        subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
        return {lines.partition("==")[0]: lines for lines in re.findall(r"(?m)^\S.*\n(?: .*\n)*", output.read_text())}
    finally:
        output.unlink()


def _without_head(text: str) -> str:
    return re.sub(r"(?m)^[#-].*\n", "", text)


def _write(file: Path, packages: dict[str, str]) -> None:
    """The packages beneath the head of the file: its comment, and the file that it adds to."""
    head = re.findall(r"(?m)^[#-].*\n", file.read_text())
    file.write_text("".join([*head, *packages.values()]))


def _version(lines: str) -> str:
    return lines.split()[0]


if __name__ == "__main__":
    sys.exit(main())
