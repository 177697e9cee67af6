"""Pin what is installed: requirements.txt and requirements-test.txt, each package by its version and its files' hashes.

    python -m pip install uv && python scripts/pin.py

requirements.txt is what pyproject.toml asks for, with what builds the package; versions that are there stay unless
pyproject.toml forbids them by now: edit one there, or delete its lines to get the newest. Of requirements-test.txt
nothing is resolved (its head says why). The hashes are those of all files that the index lists for a version, for
whatever machine they are.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PYTHON = "3.11"
"""The oldest that Lumen runs on: what is pinned has to run there, too."""
FORM = ("--generate-hashes", "--universal", "--no-header", "--no-annotate", "--quiet", "--python-version", PYTHON)


def main() -> int:
    """Write both files; 1 where one of them could not be."""
    lib, test = ROOT / "requirements.txt", ROOT / "requirements-test.txt"
    return _write(lib, "pyproject.toml", "--group", "build") or _write(test, test.name, "--no-deps")


def _write(file: Path, *of: str) -> int:
    """Pin what `of` asks for into the file, beneath the comment on its top."""
    head = [line for line in file.read_text().splitlines() if line.startswith("#")]
    command = [sys.executable, "-m", "uv", "pip", "compile", *of, *FORM, "--output-file", file.name]
    code = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL).returncode
    pinned = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    file.write_text("\n".join([*head, *pinned]) + "\n")
    return code


if __name__ == "__main__":
    sys.exit(main())
