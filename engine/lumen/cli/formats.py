"""`--format json`: what a verb reports as one object, for programs."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from typing import Any


def configure_format(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def print_object(data: Any) -> None:
    """Print one object on one line."""
    print(json.dumps(data, ensure_ascii=False), flush=True)


@contextmanager
def one_object(format: str) -> Iterator[Callable[[Any], None]]:
    """What takes the object that is printed at the end, where it is wanted: then what is told meanwhile goes to
    standard error.
    """
    found: list[Any] = []
    if format != "json":
        yield found.append
        return
    with redirect_stdout(sys.stderr):
        yield found.append
    for data in found:
        print_object(data)
