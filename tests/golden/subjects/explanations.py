"""The output of `lumen explain` for each code of lint: its meaning, and examples with the marks of their findings."""

import json
from pathlib import Path
from typing import Any

from tests.golden.command_line import lumen, workplace
from tests.golden.found import write_json

SUITE = "test"


def record(folder: Path) -> None:
    """Write the explanations by family."""
    families: dict[str, dict[str, Any]] = {}
    with workplace() as work:
        codes = json.loads(lumen(work, "explain", "--format", "json").out)["codes"]
        assert len(codes) > 200
        for entry in codes:
            outcome = lumen(work, "explain", entry["code"], "--format", "json")
            assert outcome.code == 0, outcome
            families.setdefault(entry["family"], {})[entry["code"]] = json.loads(outcome.out)
    for family, told in families.items():
        write_json(folder / f"{family.replace(' ', '-')}.json", told)
