"""`lumen new DIR`: a project to be made one's own."""

import argparse
from pathlib import Path

from lumen.cli.formats import configure_format, print_object
from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.project.building import main_settings
from lumen.project.lending import shipped_models
from lumen.run.starting import STARTERS, start_project

ACTION = "OWNER/lumen@COMMIT"
"""Stands where the address of this repository and a commit of it are to be."""


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", metavar="DIR", type=Path, help="the new folder; it must be empty or not exist yet")
    which = parser.add_mutually_exclusive_group()
    summary = "; ".join(f"{name}: {what}" for name, what in STARTERS.items())
    which.add_argument(
        "--like", choices=STARTERS, default="tour", help=f"the project to start from (default: tour); {summary}"
    )
    which.add_argument(
        "--minimal", dest="like", action="store_const", const="minimal", help="the same as --like minimal"
    )
    parser.add_argument(
        "--robot", metavar="NAME", default="", help=f"the robot of the project: {', '.join(shipped_models())}"
    )
    parser.add_argument(
        "--action",
        metavar=ACTION,
        default=ACTION,
        help="Lumen's GitHub action: its repository, and the full hash of a commit",
    )
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    folder: Path = options.folder
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise UsageError(f"{folder} already exists and is not empty: name a new folder")
        if options.robot and options.robot not in shipped_models():
            hint = did_you_mean(options.robot, shipped_models(), "there are")
            raise UsageError(f"no robot `{options.robot}` comes with Lumen: {hint}")
        start_project(folder, options.like, options.action, options.robot)
    except OSError as error:
        raise UsageError(f"can't write {error.filename or folder}: {error.strerror}") from None
    settings = main_settings(folder)
    behavior, story = (settings.behavior, settings.story) if settings else ("", "")
    if options.format == "json":
        print_object({"folder": str(folder), "like": options.like, "behavior": behavior, "story": story})
        return 0
    print(f"{folder} now has a complete exhibition; its README.md lists the files. Next:")
    print(f"  cd {folder}")
    print(f"  {f'lumen run --story {story}':<29}a scripted visitor meets the robot")
    print("  lumen lint                   after every change: what is wrong, and where")
    print(f"  {f'behaviors/{behavior}.yaml':<29}what the robot does and says; you can change it during a run")
    return 0
