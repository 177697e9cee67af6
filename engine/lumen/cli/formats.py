"""`--format json`: the output of a subcommand as one JSON object, for programs."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from typing import Any


def configure_format(parser: argparse.ArgumentParser) -> None:
    """Add `--format` with the choices `text` and `json`."""
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def print_object(data: Any) -> None:
    """Print a value as JSON on one line, and flush."""
    print(json.dumps(data, ensure_ascii=False), flush=True)


@contextmanager
def one_object(format: str) -> Iterator[Callable[[Any], None]]:
    """Yield a function that receives the object to print; with `json` it is printed when the block ends.

    With `json` everything else that the block prints goes to standard error. With any other format the object is
    ignored.
    """
    found: list[Any] = []
    if format != "json":
        yield found.append
        return
    with redirect_stdout(sys.stderr):
        yield found.append
    for data in found:
        print_object(data)
