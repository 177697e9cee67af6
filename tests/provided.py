"""Programs of the machine that tests use; a test is skipped if scripts/packages.sh could not provide its program."""

import shutil
from pathlib import Path
from typing import NoReturn

import pytest

from tests import ROOT

MISSING = ROOT / ".cache/debian.missing"
"""The packages that scripts/packages.sh could not provide: a line for each, with the reason."""


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test that draws pictures if OpenGL's libraries could not be provided."""
    if item.get_closest_marker("pictures"):
        for package in ("libegl1", "libgl1"):
            if told := not_provided(package):
                pytest.skip(told)


def program(name: str, package: str = "") -> Path:
    """Return a program of a Debian package, called the same if no `package` is given.

    Without it the test is skipped if scripts/packages.sh could not provide the package, and fails otherwise.
    """
    found = shutil.which(name)
    return Path(found) if found else lack(package or name)


def lack(package: str) -> NoReturn:
    """Skip the test if the package could not be provided, with the reason; else fail it. At import: skip the file."""
    if told := not_provided(package):
        pytest.skip(told, allow_module_level=True)
    pytest.fail(f"{package} is not on this machine: `make setup` installs it", pytrace=False)


def not_provided(package: str) -> str:
    """Return why scripts/packages.sh could not provide a package; empty if it could."""
    lines = MISSING.read_text().splitlines() if MISSING.exists() else []
    return next((line for line in lines if line.partition(" ")[0] == package), "")
