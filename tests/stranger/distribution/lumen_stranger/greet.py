"""`lumen greet`: the name of a project's exhibition, as a greeting."""

import argparse

import lumen


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", nargs="?", metavar="PROJECT", help="the project's folder (default: the shipped one)")
    parser.add_argument("--loud", action="store_true", help="use capital letters")


def run(options: argparse.Namespace) -> int:
    """Print the greeting; 0."""
    text = f"Welcome to {lumen.load(options.project).name}!"
    print(text.upper() if options.loud else text)
    return 0
