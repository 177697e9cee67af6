"""`lumen replay`: run recorded visits again, with the files that ran then or with others, and compare."""

import argparse
from collections.abc import Callable, Iterable
from pathlib import Path

import lumen
from lumen.cli.formats import configure_format, print_object
from lumen.cli.progress import progress
from lumen.cli.projects import shown_project
from lumen.cli.reach import configure_robot_name
from lumen.cli.replay_text import replay_lines
from lumen.cli.transcript import Transcript
from lumen.cli.workers_option import configure_workers
from lumen.insight.replay.entries import RecordedEntry
from lumen.language.iso_time import local_time
from lumen.project.chosen_robot import as_robot
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import ChosenJournal, KeptBundles, chosen, listed, until
from lumen.run.replaying.other_files import against
from lumen.run.replaying.replay_report import ReplayReport, replayed
from lumen.run.replaying.shared_replay import replay_kit, shared_against, shared_replay
from lumen.run.replaying.show import show
from lumen.run.setup import SPEEDS, set_up
from lumen.run.versions import version
from lumen.run.workers.workers import workers_of

SMALL = 1_000_000
"""The size below which a journal is replayed in this process [bytes]: workers would take longer to start."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen replay` to its parser."""
    add = parser.add_argument
    add(
        "what",
        nargs="?",
        metavar="FILE|DAY",
        help="a .journal file, today, yesterday or 2026-11-23 (default: the last run)",
    )
    add("--all", action="store_true", help="replay every recorded visit")
    add("--list", action="store_true", help="list the files of the journal")
    add("--project", metavar="DIR", help="the project whose journal is read (default: this folder or one above)")
    add("--until", metavar="14:03", help="only up to this time of day")
    add("--bundle", metavar="DIR", help="replay with these files: a folder, or a revision such as HEAD~1")
    add("--robot", choices=("recording", "simulation"), help="perform it again on this robot")
    add("--speed", choices=SPEEDS, default="1", help="with --robot: speed, as a multiple of real time (default: 1)")
    configure_robot_name(parser)
    configure_workers(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Replay visits and print the differences; return 1 if there are any, else 0."""
    root = shown_project(options.project)
    robot = one_robot(root, options.robot_name)
    if options.list:
        return _list(root, robot)
    journal = chosen(root, options.what, all=options.all, robot=robot)
    entries = journal.entries()
    if options.until:
        entries = until(entries, options.until)
    bundles = KeptBundles(root, robot)
    if options.robot:
        return _show(root, entries, bundles, options)
    with progress() as tell:
        report = _report(journal, entries, bundles, options, lambda done: tell(done, 0.0, f"{done} visits played"))
    if options.format == "json":
        print_object(report.to_json())
    else:
        print("\n".join(replay_lines(report, other=options.bundle is not None)))
    return int(bool(report.differ))


def _report(
    journal: ChosenJournal,
    entries: Iterable[RecordedEntry],
    bundles: KeptBundles,
    options: argparse.Namespace,
    tell: Callable[[int], None],
) -> ReplayReport:
    """Return the result of replaying the entries with the original files, or with those of --bundle.

    A long journal is divided among several workers.
    """
    new = version(options.bundle, journal.root, bundles.robot) if options.bundle is not None else None
    workers = workers_of(options.workers)
    size = sum(file.stat().st_size for file in journal.files)
    if workers.alone or (options.workers is None and size < SMALL):
        return against(entries, bundles, new.project, tell=tell) if new else replayed(entries, bundles.machine)
    kit = replay_kit(journal, bundles, as_robot(new.files, bundles.robot) if new else None)
    return (shared_against if new else shared_replay)(entries, bundles, kit, workers, tell)


def _show(root: Path, entries: Iterable[RecordedEntry], bundles: KeptBundles, options: argparse.Namespace) -> int:
    """Perform the recorded entries again on a robot; return 0."""
    project = lumen.load(root, robot=one_robot(root, options.robot_name))
    setup = set_up(options.robot, project, options.speed)
    try:
        show(entries, bundles, setup, Transcript(setup.clock.now, lambda: project.machine))
    finally:
        setup.robot.close()
    return 0


def _list(root: Path, robot: str) -> int:
    for file, header in listed(root, robot):
        when = local_time(header.began)
        what = (
            f"the story {header.story}"
            if header.story
            else "a program"
            if file.parent.name == "rehearsed"
            else "visits"
        )
        print(f"{when}  {file.stat().st_size:>9,} B  {what:<20} {file}")
    return 0
