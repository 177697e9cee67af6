"""`--model NAME`: another body than the one that lumen.yaml names."""

import argparse
from collections.abc import Iterable
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.project.chosen_model import choose
from lumen.project.files import composed
from lumen.project.project_folders import MODELS


def configure_model(parser: argparse.ArgumentParser) -> None:
    what = "use the body models/NAME.yaml instead of the one in lumen.yaml"
    parser.add_argument("--model", metavar="NAME", default="", help=what)


def use_model(name: str, roots: Iterable[Path]) -> None:
    """Take that body from now on, none where it is empty. Raises UsageError where a project has no such one."""
    if not name:
        return
    from lumen.project.lending import shipped_models  # only who asks for one waits for it

    for root in roots:
        known = {*shipped_models(), *(composed(file.stem) for file in (root / MODELS).glob("*.yaml"))}
        if name not in known:
            raise UsageError(f"there is no model `{name}`: {did_you_mean(name, known, 'there are')}")
    choose(name)
