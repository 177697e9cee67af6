"""Which exhibition a verb is about."""

import argparse

from lumen.app.reaching import Reached, reach_exhibition


def configure_reach(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="whose exhibition; default: the one here or above"
    )
    parser.add_argument("--bus", metavar="URL", help="where it runs; default: LUMEN_BUS, then this machine")


def reach(options: argparse.Namespace) -> Reached:
    """The bus of the exhibition that is meant. Raises BusError, saying what to do, where none is found."""
    return reach_exhibition(options.project, options.bus)
