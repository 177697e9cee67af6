"""Programs of others to compare with, fetched by the first test that needs them: see scripts/fetched.txt."""

import sys
from functools import cache
from pathlib import Path

import pytest

from tests import ROOT
from tests.environment import downloading
from tests.guarded import run_guarded
from tests.provided import not_provided


@cache
def fetched(name: str) -> Path:
    """Return the folder `.cache/NAME` with all that the table has under it.

    Fails the test if fetching fails; skips it if this machine has no npm and could not be given one.
    """
    folder = f".cache/{name}"
    command = [sys.executable, ROOT / "scripts/fetch.py", folder]
    done = run_guarded(command, env=downloading(), capture_output=True, text=True)
    if done.returncode:
        if "npm is not installed" in done.stderr and (told := not_provided("npm")):
            pytest.skip(told, allow_module_level=True)
        pytest.fail(done.stderr, pytrace=False)
    return ROOT / folder
