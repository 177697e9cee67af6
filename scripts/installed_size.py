"""Print the size of Lumen on the disk: `python scripts/installed_size.py [EXTRA …]`, of the core, then with each extra.

A wheel is built from this checkout and installed in an environment that is otherwise empty, even of pip. The size is
that of the packages' files; the size of Python's bytecode is printed separately, since not every installer compiles it.
"""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet")


class Size(NamedTuple):
    """The content of an environment: [MB] of files without bytecode, [MB] of bytecode, and the number of packages."""

    files: float
    bytecode: float
    packages: int

    def __str__(self) -> str:
        return f"{self.files:4.0f} MB in {self.packages} packages, and {self.bytecode:.0f} MB of bytecode"


def main() -> None:
    """Print one line for the core and one for each extra."""
    with tempfile.TemporaryDirectory() as folder:
        wheel = build(Path(folder))
        for extra in ("", *sys.argv[1:]):
            python = environment(Path(folder, extra or "core"))
            install(python, f"{wheel}[{extra}]" if extra else str(wheel))
            print(f"{extra or 'core':<16}{size(python)}", flush=True)


def build(folder: Path) -> Path:
    """Return the wheel of this checkout, built there with the pinned requirements installed here."""
    command = [*PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), str(ROOT)]
    subprocess.run(command, check=True)
    return next(folder.glob("lumen_robot-*.whl"))


def environment(folder: Path) -> Path:
    """Make an empty environment; return its Python."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder)], check=True)
    return folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")


def install(python: Path, *what: str) -> None:
    """Install packages in another environment with the pip of this one."""
    subprocess.run([*PIP, "--python", str(python), "install", *what], check=True)


def size(python: Path) -> Size:
    """Return the size of the packages in an environment."""
    code = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = Path(subprocess.run([python, "-c", code], check=True, capture_output=True, text=True).stdout.strip())
    files = [(file.suffix == ".pyc", file.stat().st_size / 1e6) for file in packages.rglob("*") if file.is_file()]
    plain, compiled = (sum(size for bytecode, size in files if bytecode is kind) for kind in (False, True))
    return Size(plain, compiled, sum(1 for _ in packages.glob("*.dist-info")))


if __name__ == "__main__":
    main()
