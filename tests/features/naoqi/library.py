"""The package qi, or a stand-in on Pythons without a wheel of it; there the tests of the fake NAO are skipped."""

import sys
from typing import Any
from unittest.mock import MagicMock

import pytest

__all__ = ["demand", "qi"]

if sys.version_info < (3, 13):  # as in pyproject.toml
    import qi
else:
    qi: Any = MagicMock(name="qi")


def demand() -> None:
    """Skip the test if this Python has no qi."""
    if sys.version_info >= (3, 13):
        pytest.skip("qi has no wheel for Python 3.13 and later")
