"""`--workers`: who does what takes long."""

import argparse


def configure_workers(parser: argparse.ArgumentParser, goes_with: str = "") -> None:
    what = f"{goes_with}number of processes, or a cluster: dask://HOST:8786 (default: one per core)"
    parser.add_argument("--workers", metavar="N", help=what)
