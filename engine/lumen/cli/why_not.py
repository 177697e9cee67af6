"""`lumen why-not WHAT`: print why something did not happen, and which change would have caused it."""

import argparse

from lumen.cli.answers import why_not_lines
from lumen.cli.questions import configure_question, put
from lumen.language.operator_requests import WHY_NOT


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen why-not` to its parser."""
    parser.add_argument("what", metavar="WHAT", help="a state, a motion, or words that the robot did not say")
    configure_question(parser)


def run(options: argparse.Namespace) -> int:
    """Print the reasons; return 0, or 1 if the event did happen or the name is unknown."""
    return put(options, WHY_NOT, why_not_lines)
