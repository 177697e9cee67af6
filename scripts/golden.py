"""Record goldens: `python scripts/golden.py [SUBJECT …]`, all of them by default.

A recording changes only in a commit of its own, with its reason in docs/decisions/. `tests` is no subject: it makes the
present number of tests the floor with which `scripts/collected.py` compares.
"""

import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.golden import collected  # noqa: E402
from tests.golden.golden import RECORDED, differences, names, record  # noqa: E402

COUNTED = "tests"


def main(wanted: list[str]) -> int:
    """Record the subjects and print the changes; return 2 for an unknown name."""
    if unknown := sorted(set(wanted) - {*names(), COUNTED}):
        print(f"unknown {', '.join(unknown)}: choose from {', '.join([*names(), COUNTED])}", file=sys.stderr)
        return 2
    if COUNTED in wanted:
        collected.raise_floors(collected.collected())
    for name in [one for one in wanted if one != COUNTED] if wanted else names():
        with tempfile.TemporaryDirectory() as folder:
            record(name, Path(folder))
            for line in differences(RECORDED / name, Path(folder)):
                print(f"{name}/{line}")
            shutil.rmtree(RECORDED / name, ignore_errors=True)
            shutil.copytree(folder, RECORDED / name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
