"""Say which tests are silently not collected: `python scripts/collected.py`, a part of `make check`.

It compares the collected tests with those in the files, and with the floors that `python scripts/golden.py tests` raises.
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
