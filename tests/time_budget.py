"""Tests for as long as one waits: `-p tests.time_budget --begin-within SECONDS` skips those that would begin later.

With the nearest tests first (`scripts/nearest.py`) these are the ones that a change has least to do with.
"""

import time

import pytest

BEGAN = time.monotonic()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--begin-within", type=float, metavar="SECONDS", help="skip tests that would begin later")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    limit = item.config.getoption("--begin-within")
    if limit is not None and time.monotonic() - BEGAN > limit:
        pytest.skip(f"not within {limit:g} s: `make test` runs it")
