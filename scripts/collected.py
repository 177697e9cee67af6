"""Say which tests are silently not collected: `python scripts/collected.py`, a part of `make check`.

It compares the tests that pytest collects with those that are written, and with the floors (`scripts/golden.py tests`).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.golden.collected import collected, faults, floors


def main() -> int:
    """Print a sentence for each fault; 1 if there is one."""
    found = list(faults(collected(), floors()))
    print(*found, sep="\n", end="\n" if found else "", file=sys.stderr)
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
