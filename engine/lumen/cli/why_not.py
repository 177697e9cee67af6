"""`lumen why-not WHAT`: why something did not happen, and what would have made it."""

import argparse

from lumen.cli.answers import why_not_lines
from lumen.cli.questions import configure_question, put
from lumen.language.operator_requests import WHY_NOT


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("what", metavar="WHAT", help="a state, a motion, or words that the robot did not say")
    configure_question(parser)


def run(options: argparse.Namespace) -> int:
    """0 where it did not happen, and something could have led there."""
    return put(options, WHY_NOT, why_not_lines)
