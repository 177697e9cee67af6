"""How far something long is."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from lumen.app.lint.physics import ProgressHook


@contextmanager
def progress() -> Iterator[ProgressHook]:
    """A bar on a terminal, of which nothing is left at the end."""
    terminal = sys.stderr.isatty()

    def tell(done: int, whole: int, name: str) -> None:
        if terminal:
            bar = "#" * (30 * done // max(whole, 1))
            print(f"\r\x1b[K[{bar:<30}] {done} of {whole}  {name}", end="", file=sys.stderr, flush=True)

    try:
        yield tell
    finally:
        if terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
