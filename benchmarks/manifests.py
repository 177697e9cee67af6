"""Measure the processor time to read all manifests of features: `python benchmarks/manifests.py`.

Each pass is a process of its own. Imports of `lumen.feature` and of the Python modules that it uses are not included.
"""

import sys
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import run_guarded

PASSES = 9
LIMIT = 15.0
"""The limit for reading the manifests of Lumen [ms]."""
CODE = """
import time
import lumen.feature as feature
from lumen.distributions import distributions

begun = time.process_time()
found = [feature.resolve(where) for where in feature.BUILT_IN]
read = time.process_time()
distributions()
print((read - begun) * 1e3, (time.process_time() - read) * 1e3, len(found))
"""


def main() -> int:
    """Print the times; return 0 if reading takes less than the limit."""
    passes = [
        run_guarded([sys.executable, "-c", CODE], capture_output=True, text=True, check=True) for _ in range(PASSES)
    ]
    times = [[float(word) for word in each.stdout.split()] for each in passes]
    manifests, scan, count = (median(column) for column in zip(*times, strict=True))
    print(f"{count:.0f} manifests that come with Lumen   {manifests:6.1f} ms (limit {LIMIT:.0f} ms)")
    print(f"metadata of installed distributions {scan:6.1f} ms")
    return int(manifests >= LIMIT)


if __name__ == "__main__":
    sys.exit(main())
