"""`--imperfections`: simulate a robot with imperfections other than lumen.yaml's."""

import argparse

from lumen.errors import UsageError
from lumen.features.simulation.settings import IMPERFECTIONS, PERFECT, Imperfections, only
from lumen.language.diagnostics import did_you_mean


def configure_imperfections(parser: argparse.ArgumentParser) -> None:
    """Add `--imperfections` to a command that simulates a robot."""
    names = ", ".join(IMPERFECTIONS)
    what = f"imperfections of the simulated robot: `none`, or a list of {names} (default: as in lumen.yaml, else all)"
    parser.add_argument("--imperfections", metavar="LIST", help=what)


def imperfections_of(text: str | None) -> Imperfections | None:
    """Return the imperfections listed in `text`, such as `noise,latency` or `none`; None if `text` is None.

    Raises UsageError for an unknown name.
    """
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
