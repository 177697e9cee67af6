"""A bus of this process for each test."""

from pathlib import Path

import pytest


@pytest.fixture
def address(tmp_path: Path) -> str:
    """The address of a bus that this test alone has: one with a fixed name lives on in whatever is not closed."""
    return f"memory://{tmp_path}"
