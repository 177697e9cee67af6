"""`lumen why [WHAT]`: print why something happened, back to its first cause."""

import argparse

from lumen.cli.answers import why_lines
from lumen.cli.questions import configure_question, put
from lumen.language.operator_requests import WHY


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen why` to its parser."""
    parser.add_argument(
        "what",
        nargs="?",
        metavar="WHAT",
        help="words that were said, a state, a motion, or a command's id (default: the last thing that happened)",
    )
    configure_question(parser)


def run(options: argparse.Namespace) -> int:
    """Print the causes; return 0, or 1 if the exhibition knows of no such event."""
    return put(options, WHY, why_lines)
