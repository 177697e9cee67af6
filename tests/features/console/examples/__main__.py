"""Serve the examples of the pages' components for an author: `python -m tests.features.console.examples`."""

import sys

from tests.features.console.examples import Examples

if __name__ == "__main__":
    with Examples(8099) as examples:
        sys.stdout.write(f"{examples.address}examples/index.html, until Enter is pressed\n")
        input()
