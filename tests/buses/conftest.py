"""A bus of this process for each test."""

from pathlib import Path

import pytest


@pytest.fixture
def address(tmp_path: Path) -> str:
    """The address of a bus for this test alone: a shared name would connect it to buses that are still open."""
    return f"memory://{tmp_path}"
