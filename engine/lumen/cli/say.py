"""`lumen say TEXT`: the robot of a running exhibition says something."""

import argparse

from lumen.cli.commanding import command
from lumen.cli.formats import configure_format
from lumen.cli.reach import configure_reach
from lumen.errors import UsageError


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("text", metavar="TEXT", help="what it says")
    parser.add_argument("--language", metavar="LANG", default="", help="in which language (default: the one it speaks)")
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """0 once it has said it, 1 where it could not."""
    if not options.text.strip():
        raise UsageError("there is nothing to say: write the text in quotes")
    parameter = {"text": options.text, "language": options.language}
    return command(options, {"type": "texttospeech", "method": "say", "parameter": parameter}, "said")
