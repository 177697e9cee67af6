"""`lumen lint`: what is wrong in a project, and where."""

import argparse

from lumen.cli.render import FORMATS
from lumen.cli.terminal import coloured
from lumen.language.diagnostics import Severity
from lumen.loading.packaged import find_project
from lumen.loading.project import read_files
from lumen.rules import check_files


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="its folder; default: here or above, else the shipped one"
    )
    parser.add_argument("--format", choices=tuple(FORMATS), default="text", help="how to print it (default: text)")
    parser.add_argument("--strict", action="store_true", help="count warnings as errors")


def run(options: argparse.Namespace) -> int:
    """0 where nothing is wrong, 1 where something is."""
    root = find_project(options.project)
    files = read_files(root)
    diagnostics = check_files(root, files)[1]
    shown = FORMATS[options.format](diagnostics, files, coloured=coloured())
    print(shown.encode("utf-8", "replace").decode())
    counted = (Severity.ERROR, Severity.WARNING) if options.strict else (Severity.ERROR,)
    return int(any(d.severity in counted for d in diagnostics))
