"""`lumen why [WHAT]`: why something happened, back to whoever or whatever caused it."""

import argparse

from lumen.cli.answers import why_lines
from lumen.cli.questions import configure_question, put
from lumen.language.operator_requests import WHY


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "what",
        nargs="?",
        metavar="WHAT",
        help="words that were said, a state, a motion, or a command's id (default: the last thing that happened)",
    )
    configure_question(parser)


def run(options: argparse.Namespace) -> int:
    """0 where it happened."""
    return put(options, WHY, why_lines)
