"""`lumen stop`: the robot of a running exhibition rests, at once."""

import argparse

from lumen.app.reload.requests import COMMAND
from lumen.cli.commanding import command
from lumen.cli.reach import configure_reach


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)


def run(options: argparse.Namespace) -> int:
    """0 once it rests, 1 where it could not. The behaviour is told as well, so that it does not go on."""
    rest = {"type": "motion", "method": "rest"}
    return command(options, rest, "the robot rests", first=(COMMAND, {"command": "stop"}))
