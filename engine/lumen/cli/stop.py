"""`lumen stop`: the robot of a running exhibition rests, at once."""

import argparse

from lumen.cli.commanding import command
from lumen.cli.reach import configure_reach


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)


def run(options: argparse.Namespace) -> int:
    """0 once it rests, 1 where it could not."""
    return command(options, {"type": "motion", "method": "rest"}, "the robot rests")
