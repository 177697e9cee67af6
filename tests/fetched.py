"""What the tests ask others with, fetched by whichever test needs it first: see scripts/fetched.txt."""

import sys
from functools import cache
from pathlib import Path

import pytest

from tests.guarded import run_guarded

ROOT = Path(__file__).parents[1]


def not_provided() -> str:
    """What scripts/packages.sh says that this machine lacks, empty where it lacks nothing."""
    told = ROOT / ".cache/debian.missing"
    return told.read_text().strip() if told.exists() else ""


@cache
def fetched(name: str) -> Path:
    """The folder `.cache/NAME` with all that the table has under it.

    Fails the test where it can't be had; leaves it out where this machine has no npm and could not be given one.
    """
    folder = f".cache/{name}"
    done = run_guarded([sys.executable, ROOT / "scripts/fetch.py", folder], capture_output=True, text=True)
    if done.returncode:
        if "npm is not installed" in done.stderr and "npm" in (told := not_provided()):
            pytest.skip(told)
        pytest.fail(done.stderr, pytrace=False)
    return ROOT / folder
