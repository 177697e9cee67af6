"""What the tests ask others with, fetched by whichever test needs it first: see scripts/fetched.txt."""

import sys
from functools import cache
from pathlib import Path

import pytest

from tests.guarded import run_guarded

ROOT = Path(__file__).parents[1]


@cache
def fetched(name: str) -> Path:
    """The folder `.cache/NAME` with all that the table has under it; fails the test where it can't be had."""
    folder = f".cache/{name}"
    done = run_guarded([sys.executable, ROOT / "scripts/fetch.py", folder], capture_output=True, text=True)
    if done.returncode:
        pytest.fail(done.stderr, pytrace=False)
    return ROOT / folder
