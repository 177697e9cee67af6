"""`lumen new DIR`: create a project; `lumen new KIND NAME`: add files to a project."""

import argparse
from pathlib import Path

from lumen.cli.formats import configure_format, print_object
from lumen.errors import UsageError
from lumen.feature import owner, table
from lumen.language.diagnostics import did_you_mean
from lumen.project.broken_features import called
from lumen.project.lending import shipped_models
from lumen.project.main_file import main_settings
from lumen.project.running_project import own_project
from lumen.run.starting import STARTERS, start_project
from lumen.run.templates import TEMPLATES, write_template

ACTION = "OWNER/lumen@COMMIT"
"""A placeholder for the address of this repository and a commit of it."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen new` to its parser."""
    kinds = ", ".join(_kinds())
    what = f"the new folder, which must be empty or not exist yet; or what to add to a project: {kinds}"
    parser.add_argument("folder", metavar="DIR|KIND", help=what)
    parser.add_argument("name", metavar="NAME", nargs="?", default="", help="the name of the addition")
    parser.add_argument("--project", metavar="DIR", help="the project to add to (default: this folder or one above)")
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
    """Create a project in a new folder, or add to one if DIR is a kind of addition; return 0.

    Raises UsageError if the folder is not empty, the robot is unknown, or a file can't be written.
    """
    if options.name or options.folder in _kinds():
        return _add(options, options.folder)
    folder = Path(options.folder)
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


def _add(options: argparse.Namespace, kind: str) -> int:
    """Add files to a project, from a template of Lumen or of a feature; print them and return 0."""
    kinds = _kinds()
    if kind not in kinds:
        raise UsageError(f"can't add a `{kind}` to a project: {did_you_mean(kind, kinds, 'choose one of')}")
    if not options.name:
        raise UsageError(
            f"write `lumen new {kind} NAME`; for a project in a folder `{kind}` write `lumen new ./{kind}`"
        )
    root = own_project(options.project)
    try:
        if kind in TEMPLATES:
            written = write_template(kind, options.name, root)
            files, steps = [*written.files], [*written.next]
        else:
            files = called(owner("new_files", kind), table("new_files")[kind], root, options.name)
            stories = (Path(file).stem for file in files if file.startswith("behaviors/stories/"))
            steps = [("lumen lint", "what is wrong, and where")]
            steps += [(f"lumen test {story}", "plays its story") for story in stories]
    except OSError as error:
        raise UsageError(f"can't write {error.filename or root}: {error.strerror}") from None
    if options.format == "json":
        print_object({"kind": kind, "name": options.name, "files": files})
        return 0
    print(f"wrote {' and '.join(files)}. Next:")
    width = max(len(step) for step, _ in steps) + 3
    for step, purpose in steps:
        print(f"  {step:<{width}}{purpose}")
    return 0


def _kinds() -> tuple[str, ...]:
    """Return the kinds of files that can be added to a project: the templates of Lumen, and those of features."""
    return (*TEMPLATES, *table("new_files"))
