"""The greatest values that figures of the architecture may have."""

from pathlib import Path

import yaml

ENTERING = "entering callables"
"""The figure that is found in a running exhibition, by test_entering.py; the others are read from the code."""


def ceilings() -> dict[str, int]:
    """Return all rows of ceilings.yaml: the name of each figure, and its greatest value."""
    found = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
    return {str(name): int(value) for name, value in found.items()}
