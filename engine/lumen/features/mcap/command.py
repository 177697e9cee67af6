"""`lumen record`: records a running exhibition's messages into a file for Foxglove and Lichtblick."""

import argparse
import json
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.cli.progress import progress
from lumen.cli.reach import reach
from lumen.errors import BusError, UsageError
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import renamed, writable
from lumen.features.mcap.files.rewriting import recover
from lumen.features.mcap.notes import bundle_files, journal_files, notes_of
from lumen.features.mcap.recorder import Recorder
from lumen.features.mcap.recordings_folder import SUFFIX, RecordingsFolder
from lumen.features.mcap.recovering import remove_drafts
from lumen.features.mcap.robot_view import RobotView
from lumen.features.mcap.tape_file import FileTape
from lumen.language.counts import counted
from lumen.language.iso_time import file_stamp
from lumen.language.operator_requests import MARK, STATUS
from lumen.language.projects import Project
from lumen.language.retention import RecordingSettings
from lumen.lint import check_files
from lumen.ports import Bus, EndsWithExhibition
from lumen.project.chosen_robot import as_robot
from lumen.project.files import read_files
from lumen.project.home import Home, home_of
from lumen.project.running_project import project_to_run
from lumen.project.units import seconds
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.reaching import Reached
from lumen.run.snapshot_store import SnapshotStore

LOOK = 0.1
"""The time between two checks of whether to stop [s]."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen record` to the parser."""
    add = parser.add_argument
    add(
        "file",
        nargs="?",
        metavar="FILE.mcap",
        type=Path,
        help="the file to write (default: a new one in .lumen/recordings/)",
    )
    add("--for", dest="span", metavar="TIME", help="stop after this time, such as 2min (default: at Ctrl-C)")
    add("--no-camera", action="store_true", help="leave out the camera's images")
    add(
        "--mark",
        nargs="?",
        const="",
        metavar="TEXT",
        help="mark this moment, and keep the last minutes if `record: {ring: …}` is set",
    )
    add("--recover", metavar="FILE.mcap", type=Path, help="repair a recording that was cut off")
    add("--project", metavar="DIR", help="the exhibition's folder (default: this folder or one above)")
    add("--bus", metavar="URL", help="the exhibition's bus (default: LUMEN_BUS, then this machine)")
    add("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Record, repair a file or mark this moment; return the exit code, 0 on success.

    Raises UsageError if an option is invalid or the file can't be written, RecordingError if it can't be repaired.
    """
    if options.recover:
        return _recover(options)
    span = seconds(options.span) if options.span else None
    if options.span and not span:
        raise UsageError(f"invalid `--for {options.span}`: write a number and its unit, such as `20s` or `2min`")
    reached = reach(options)
    try:
        return _record(options, reached, span) if options.mark is None else _mark(options, reached)
    finally:
        reached.bus.close()


def _recover(options: argparse.Namespace) -> int:
    path = options.recover
    remove_drafts(path)
    count = recover(path)
    again = f"{path} is complete again: {counted(count or 0, 'message')}"
    said = f"{path} is complete: nothing to recover" if count is None else again
    _say(options, said, file=str(path), messages=count)
    return 0


def _mark(options: argparse.Namespace, reached: Reached) -> int:
    answer = next(send_request(reached.bus, operator_key(reached.robot), MARK(text=options.mark), OPERATOR_ANSWERS))
    done = answer.get("verdict") == "done" if isinstance(answer, dict) else False
    text = str(answer.get("text" if done else "reason", "")) if isinstance(answer, dict) else str(answer)
    _say(options, f"marked: {text}" if done else f"nothing is kept: {text}", marked=done, reason=text)
    return 0 if done else 1


def _record(options: argparse.Namespace, reached: Reached, span: float | None) -> int:
    root = project_to_run(options.project)
    bus = reached.bus
    project, folder = _running_project(root, reached), RecordingsFolder(home_of(root, reached.home))
    view = RobotView(project, lambda text: print(text, file=sys.stderr))
    path = options.file or folder.path / f"{file_stamp(time.time())}-recorded{SUFFIX}"
    try:
        if options.file is None:
            folder.make()
        first: list[Recorded] = [
            notes_of(project),
            *bundle_files(root, [project.hash], reached.home),
            *view.look(time.time()),
        ]
        free = writable(path)
        if other := renamed(path, free):
            print(other, file=sys.stderr)
        tape = FileTape(free, folder, first, lambda began: journal_files(root, began, time.time(), reached.home))
    except OSError as error:
        raise UsageError(f"{path} can't be written: {error.strerror}") from None
    camera = project.section(RecordingSettings).camera and not options.no_camera
    recorder = Recorder(bus, project, [tape], camera=camera, extra=view)
    try:
        recorder.start()
        _wait(bus, tape, span)
    finally:
        recorder.close()
    lost = (
        f"; {counted(recorder.dropped, 'message')} could not be recorded: the disk was too slow"
        if recorder.dropped
        else ""
    )
    said = tape.trouble or f"recorded {tape.path}: {counted(tape.messages, 'message')}, {tape.bytes / 1e6:.1f} MB{lost}"
    _say(options, said, file=str(tape.path), messages=tape.messages, bytes=tape.bytes, dropped=recorder.dropped)
    return 1 if tape.trouble else 0


def _wait(bus: Bus, tape: FileTape, span: float | None) -> None:
    """Wait until `span` [s] is over, Ctrl-C is pressed, the disk fails, or the exhibition ends."""
    began, ends = time.monotonic(), bus.ability(EndsWithExhibition)
    with suppress(KeyboardInterrupt), progress() as tell:
        while not tape.trouble and not (ends and ends.gone.is_set()):
            waited = time.monotonic() - began
            if span is not None and waited >= span:
                return
            tell(waited, span or 0.0, "s recorded")
            time.sleep(LOOK)


def _running_project(root: Path, reached: Reached) -> Project:
    """Return the running project if its files are stored, else the project in the folder `root`.

    Raises UsageError if it has errors.
    """
    kept: dict[str, bytes] | None = None
    with suppress(BusError, TypeError, KeyError):
        status = next(send_request(reached.bus, operator_key(reached.robot), STATUS(), OPERATOR_ANSWERS))
        kept = SnapshotStore(Home(home_of(root, reached.home))).files(str(status["bundle"]))
    project = check_files(root, as_robot(kept or read_files(root), reached.home))[0]
    if project is None:
        raise UsageError(f"the files of {root} have errors, so its messages are unknown: run `lumen lint`")
    return project


def _say(options: argparse.Namespace, text: str, **data: Any) -> None:
    print(json.dumps(data, ensure_ascii=False) if options.format == "json" else text)
