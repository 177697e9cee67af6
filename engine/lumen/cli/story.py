"""`lumen story`: write a recorded visit as a story, to keep it as a test."""

import argparse
from pathlib import Path

import lumen
from lumen.cli.formats import configure_format, print_object
from lumen.cli.projects import shown_project
from lumen.cli.reach import configure_robot_name
from lumen.cli.writing import write_file, write_result
from lumen.errors import UsageError
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.storytelling.chosen_visit import chosen_visit
from lumen.run.storytelling.story_text import story_text
from lumen.run.storytelling.visit_story import renaming, visit_story


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen story` to its parser."""
    add = parser.add_argument
    add(
        "what",
        nargs="?",
        metavar="FILE|DAY",
        help="a .journal file, today, yesterday or 2026-11-23 (default: the last run)",
    )
    add("--at", metavar="14:03", help="the visit that was under way at this time (default: the last one)")
    add("-o", "--output", type=Path, metavar="FILE.yaml", help="the file to write (default: print it)")
    add("--name", action="append", default=[], metavar="OLD=NEW", help="replace a visitor's name; may be repeated")
    add("--title", help="the title of the story")
    add("--force", action="store_true", help="replace an existing file")
    add("--project", metavar="DIR", help="the project whose journal is read (default: this folder or one above)")
    configure_robot_name(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Write the story; return 0 if its course is that of the visit, 1 if today's files change the course.

    Raises UsageError if the journal lacks a part of the visit or its files, or if the output file already exists.
    """
    output: Path | None = options.output
    if output and output.exists() and not options.force:
        raise UsageError(f"{output} already exists: name another file, or add --force")
    names = dict(_name(pair) for pair in options.name)
    root = shown_project(options.project)
    robot = one_robot(root, options.robot_name)
    project = lumen.load(root, robot=robot)
    root = Path(project.root)
    bundles = KeptBundles(root, robot)
    one = chosen_visit(chosen(root, options.what, robot=robot), bundles, options.at)
    home = one.visit.home
    old = bundles.project(home.bundle, home.behavior) if home else None
    if old is None:
        raise UsageError("the journal does not have the whole visit, or the files that ran then were not kept")
    title = options.title or f"A visit on {one.began:%Y-%m-%d} at {one.began:%H:%M}"
    stem = output.stem if output else "visit"
    made = visit_story(project, old, one.visit, name=stem, title=title, renamed=renaming(names))
    remarks = [f"The visit {one.when}, written by `lumen story`. It contains what people said: check it for names."]
    if not made.same:
        remarks.append(f"With today's files, the robot does something else. Then: {made.was}. Now: {made.now}.")
    text = story_text(made.story, remarks)
    if options.format == "json":
        if output:
            write_file(text.encode(), output, folders=True)
        began, ended = one.began.isoformat(), one.ended.isoformat()
        said = {"began": began, "ended": ended, "same": made.same, "was": made.was, "is": made.now}
        print_object({**said, "story": text, "wrote": str(output.absolute()) if output else None})
    else:
        write_result(text, output, folders=True)
    return int(not made.same)


def _name(pair: str) -> tuple[str, str]:
    old, separator, new = pair.partition("=")
    if not (separator and old.strip() and new.strip()):
        raise UsageError(f"invalid `--name {pair}`: write two names, such as `--name Budi=Ani`")
    return old.strip(), new.strip()
