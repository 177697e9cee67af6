"""`--imperfections`: a simulated robot that falls short in other ways than lumen.yaml says."""

import argparse

from lumen.errors import UsageError
from lumen.features.simulation.settings import IMPERFECTIONS, PERFECT, Imperfections, only
from lumen.language.diagnostics import did_you_mean


def configure_imperfections(parser: argparse.ArgumentParser) -> None:
    """`--imperfections`, for a verb that has a simulated robot."""
    names = ", ".join(IMPERFECTIONS)
    what = f"imperfections of the simulated robot: `none`, or a list of {names} (default: as in lumen.yaml, else all)"
    parser.add_argument("--imperfections", metavar="LIST", help=what)


def imperfections_of(text: str | None) -> Imperfections | None:
    """Those that were named, None where nothing was; raises UsageError for what is none."""
    if text is None:
        return None
    if text == "none":
        return PERFECT
    names = tuple(text.split(","))
    for name in names:
        if name not in IMPERFECTIONS:
            hint = did_you_mean(name, IMPERFECTIONS, "there are")
            raise UsageError(f"--imperfections has no `{name}`: {hint}")
    return only(names)
