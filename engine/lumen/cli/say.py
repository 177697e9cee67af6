"""`lumen say TEXT`: make the robot of a running exhibition say something."""

import argparse

from lumen.cli.commanding import command
from lumen.cli.formats import configure_format
from lumen.cli.reach import configure_reach
from lumen.errors import UsageError


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen say` to its parser."""
    parser.add_argument("text", metavar="TEXT", help="the text to say")
    parser.add_argument(
        "--language",
        metavar="LANG",
        default="",
        help="the language of the text (default: the one that the robot speaks)",
    )
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Send the text; return 0 once the robot has said it, 1 if it refused.

    Raises UsageError for an empty text, and BusError as `command` does.
    """
    if not options.text.strip():
        raise UsageError("the text is empty: write it in quotes")
    parameter = {"text": options.text, "language": options.language}
    return command(options, {"type": "texttospeech", "method": "say", "parameter": parameter}, "said")
