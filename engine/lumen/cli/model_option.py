"""`--model NAME`: use a body other than the one in lumen.yaml."""

import argparse
from collections.abc import Iterable
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.project.chosen_model import choose
from lumen.project.files import composed
from lumen.project.project_folders import MODELS


def configure_model(parser: argparse.ArgumentParser) -> None:
    """Add `--model`."""
    what = "use the body models/NAME.yaml instead of the one in lumen.yaml"
    parser.add_argument("--model", metavar="NAME", default="", help=what)


def use_model(name: str, roots: Iterable[Path]) -> None:
    """Make this process, and those that it starts, use the body of that name; an empty name changes nothing.

    Raises UsageError if one of the projects in `roots` has no such body, and none comes with Lumen.
    """
    if not name:
        return
    from lumen.project.lending import shipped_models  # only needed if the option is given

    for root in roots:
        known = {*shipped_models(), *(composed(file.stem) for file in (root / MODELS).glob("*.yaml"))}
        if name not in known:
            raise UsageError(f"there is no model `{name}`: {did_you_mean(name, known, 'there are')}")
    choose(name)
