"""`lumen new DIR`: a project to be made one's own; `lumen new KIND NAME`: something for a project."""

import argparse
from pathlib import Path

from lumen.cli.formats import configure_format, print_object
from lumen.errors import UsageError
from lumen.feature import resolve, table
from lumen.language.diagnostics import did_you_mean
from lumen.project.building import main_settings
from lumen.project.lending import shipped_models
from lumen.project.own_project import own_project
from lumen.run.starting import STARTERS, start_project

ACTION = "OWNER/lumen@COMMIT"
"""Stands where the address of this repository and a commit of it are to be."""


def configure(parser: argparse.ArgumentParser) -> None:
    kinds = ", ".join(table("new_files"))
    parser.add_argument(
        "words",
        nargs="+",
        metavar="DIR | KIND NAME",
        help=f"the new folder, which must be empty or not exist yet; or a kind ({kinds}) and a name: files of that kind"
        " in the project of this folder",
    )
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
    kind, *names = options.words
    if kind in table("new_files"):
        return _add(kind, names, options.format)
    if names:
        kinds = table("new_files")
        raise UsageError(f"`{kind}` is nothing that a project can be given: {did_you_mean(kind, kinds, 'there are')}")
    folder = Path(kind)
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


def _add(kind: str, names: list[str], format: str) -> int:
    """Write the files of something new into the project of this folder."""
    if len(names) != 1:
        raise UsageError(
            f"write `lumen new {kind} NAME`; for a project in a folder `{kind}` write `lumen new ./{kind}`"
        )
    root = own_project(None)
    try:
        files: list[str] = resolve(table("new_files")[kind])(root, names[0])
    except OSError as error:
        raise UsageError(f"can't write {error.filename or root}: {error.strerror}") from None
    if format == "json":
        print_object({"kind": kind, "name": names[0], "files": files})
        return 0
    print(f"the {kind} `{names[0]}` is in {', '.join(files)}. Next:")
    print("  lumen lint                   what is wrong, and where")
    for file in files:
        if file.startswith("behaviors/stories/"):
            story = Path(file).stem
            print(f"  {f'lumen test {story}':<29}plays its story")
    return 0
