"""List tests that are silently not collected: `python scripts/collected.py`, a part of `make check`.

It compares the tests that pytest collects with those in the files, and with the floors (`scripts/golden.py tests`).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.golden.collected import collected, faults, floors


def main() -> int:
    """Print a sentence for each fault; return 1 if there is any."""
    found = list(faults(collected(), floors()))
    print(*found, sep="\n", end="\n" if found else "", file=sys.stderr)
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
