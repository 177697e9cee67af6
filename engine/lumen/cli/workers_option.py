"""`--workers`: divide long work among processes or machines."""

import argparse


def configure_workers(parser: argparse.ArgumentParser, goes_with: str = "") -> None:
    """Add the option; its help begins with `goes_with`."""
    what = f"{goes_with}number of processes, or a cluster: dask://HOST:8786 (default: one per core)"
    parser.add_argument("--workers", metavar="N", help=what)
