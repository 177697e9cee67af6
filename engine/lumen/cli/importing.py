"""`lumen import`: convert a statechart, a motion, a fuzzy controller or a robot of another tool to a file of Lumen."""

import argparse
import re
import sys
from functools import partial
from pathlib import Path
from typing import Any

from lumen.cli.foreign import foreign_content, one_line
from lumen.cli.progress import progress
from lumen.cli.render import finding_formats, render
from lumen.cli.terminal import coloured
from lumen.cli.writing import write_file, write_result
from lumen.errors import UsageError
from lumen.feature import distribution_of, rows
from lumen.language.diagnostics import Diagnostic, Place, Severity, has_errors
from lumen.language.robots import Body
from lumen.language.text_lines import lines_of
from lumen.lint.motions import TOO_FAST
from lumen.motion.limits import Excess, overspeed
from lumen.project.behaviors import build_machine
from lumen.project.bodies import build_body
from lumen.project.building import motion_parts
from lumen.project.controllers import build_controller
from lumen.project.document_report import DocumentReport
from lumen.project.draft import body_of
from lumen.project.files import read_files
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.formats.importers import FileReader, RobotReader, endings, importer, read_gesture, reader, recognised
from lumen.project.formats.yaml_document import document_yaml
from lumen.project.motions import build_motion
from lumen.project.packaged import find_project
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from lumen.run.linting.findings import Findings
from lumen.upkeep.garbage import gc_paused

BEGINNINGS = {b"<": ".scxml", b"{": ".json"}
"""The ending to assume for a file without a known one, by its first byte."""
READ, WRITTEN = 20, 50
"""The progress of a large chart's import [%] when it has been read, and the share that writing adds."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen import` to its parser."""
    parser.description = (
        "Turn a statechart (SCXML, XState's JSON) into a behaviour file, a motion (Webots, Choregraphe, NAOqi's"
        " Python) into a motion file, a fuzzy controller (FuzzyLite's FLL, FCL of IEC 61131-7, MATLAB's .fis) into a"
        " controller file, or a robot (URDF, MJCF) into a body file whose roles are guessed. Parts that"
        " can't be converted are left out and listed with their lines; the exit code is then 1. If Lumen could not load"
        " the result, nothing is written, and the exit code is 2."
    ) + "".join(f" The installed package `{name}` adds {', '.join(added)}." for name, added in _added().items())
    add = parser.add_argument
    add(
        "file",
        metavar="FILE",
        type=Path,
        help="chart.scxml, machine.json, wave.motion, behavior.xar, keyframes.py, head.fll, robot.urdf, robot.xml",
    )
    add("-o", "--output", metavar="OUT.yaml", type=Path, help="write to this file instead of printing")
    add(
        "--timeline",
        metavar="NAME",
        default="",
        help="the timeline of a .xar that has several, or the function of a .py",
    )
    add("--retime", action="store_true", help="lengthen a motion where its joints would move too fast")
    add(
        "--project",
        metavar="DIR",
        help="the project whose robot a motion is for (default: this folder or one above, else the shipped one)",
    )
    add(
        "--format",
        choices=finding_formats(),
        default="text",
        help="format of the list of omissions (default: text)",
    )


def run(options: argparse.Namespace) -> int:
    """Convert the file; return 0 if everything was carried over, 1 if parts were left out.

    Raises UsageError (exit code 2) if nothing can be written.
    """
    content = foreign_content(options.file)
    title = _title(options.output or options.file)
    row, convert = recognised(content) or (importer(options.file.suffix), None)
    if row and row.kind == "robot":
        return _robot(options, convert or reader(options.file.suffix), content, title)
    if row and row.kind == "hint" and convert:
        raise UsageError(f"{options.file} {convert(content)}")
    kind, read = _reader(options.file, content)
    body = _body(options.project) if kind == "motion" else None
    if body:
        read = partial(_gesture, body, options)
    with progress() as tell, gc_paused():  # else the garbage collector traverses a large chart again and again
        tell(0, 100, f"% of {options.file}: reading")
        try:
            data, diagnostics = read(str(options.file), content, title)
        except ForeignFileError as error:
            raise UsageError(one_line(error.diagnostic)) from None
        except RecursionError:
            raise UsageError(f"{options.file} is nested too deeply: use fewer levels") from None
        tell(READ, 100, f"% of {options.file}: writing")
        text = document_yaml(data, kind)
        tell(READ + WRITTEN, 100, f"% of {options.file}: checking the result")
        faults = result_faults(str(options.output or "the result"), text, kind, body)
        if refused := next((fault for fault in faults if fault.severity is Severity.ERROR), None):
            raise UsageError(_refusal(options.file, text, refused, diagnostics))
    write_result(text, options.output)
    return _told(options, content, [*diagnostics, *faults])


def _robot(options: argparse.Namespace, read: RobotReader, content: bytes, title: str) -> int:
    """Write a body file, and the MJCF and meshes that belong to it; return the exit code."""
    try:
        text, diagnostics, beside = read(options.file, content, options.output, title)
    except ForeignFileError as error:
        raise UsageError(one_line(error.diagnostic)) from None
    faults = result_faults(str(options.output or "the result"), text, "body")
    if refused := next((fault for fault in faults if fault.severity is Severity.ERROR), None):
        raise UsageError(_refusal(options.file, text, refused, diagnostics))
    write_result(text, options.output)
    for path, other in beside.items():
        write_file(other, path, folders=True)
    if beside:
        print(f"wrote {next(iter(beside))}" + (f" and {len(beside) - 1} meshes" if len(beside) > 1 else ""))
    return _told(options, content, [*diagnostics, *faults])


def _told(options: argparse.Namespace, content: bytes, diagnostics: list[Diagnostic]) -> int:
    """Print the findings on standard error; return the exit code, 1 if one is an error."""
    if diagnostics or options.format != "text":
        files = {str(options.file): content}
        print(render(options.format, [Findings(diagnostics, files)], coloured=coloured(sys.stderr)), file=sys.stderr)
    return int(has_errors(diagnostics))


def _body(project: str | None) -> Body:
    """Return the body of a project, even if its other files have errors: an import may be part of repairing them."""
    return body_of(motion_parts(read_files(find_project(project))))


def _gesture(
    body: Body, options: argparse.Namespace, file: str, content: bytes, _: str
) -> tuple[dict[str, Any], list[Diagnostic]]:
    return read_gesture(file, content, body, timeline=options.timeline, retime=options.retime)


def _title(path: Path) -> str:
    return re.sub(r"[\s#*]+", "_", path.stem)


def _added() -> dict[str, list[str]]:
    """Return the endings of files that features of other installed packages import, by the package's name."""
    found: dict[str, list[str]] = {}
    for feature, (ending, _) in rows("importers"):
        if distribution := distribution_of(feature):
            found.setdefault(distribution.name, []).append(ending)
    return found


def _reader(path: Path, content: bytes) -> tuple[str, FileReader]:
    """Return the kind of file of Lumen to write, and the reader of the other tool's file.

    They are chosen by the file's ending, else by its first byte. Raises UsageError if neither is known.
    """
    ending = path.suffix
    row = importer(ending)
    if row is None or row.kind == "hint":
        start = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
        if start not in BEGINNINGS:
            known = ", ".join((*endings("motion"), *endings("controller")))
            raise UsageError(f"{path} is not SCXML, XState's JSON, a motion or a controller ({known})")
        ending = BEGINNINGS[start]
    row = importer(ending)
    assert row is not None
    return row.kind, reader(ending)


def _refusal(file: Path, text: str, fault: Diagnostic, said: list[Diagnostic]) -> str:
    """Return the message that nothing is written: the error in the result, and the omission that may be its cause."""
    line = lines_of(text)[fault.place.line - 1].strip() if fault.place.line else ""
    near = f" at `{line[:80]}`" if line else ""
    lost = next((d for d in said if d.severity is Severity.ERROR), None)
    cause = f"; left out: {one_line(lost)}" if lost else ""
    told = f"nothing is written: {file} would become a file with an error{near}: {fault.message}{cause}"
    return " ".join(told.split())


def result_faults(file: str, text: str, kind: str, body: Body | None = None) -> list[Diagnostic]:
    """Return the findings of loading the result, and for a motion of `body` one about joints that would be too fast."""
    document, found = parse(file, text.encode())
    if document is None:
        return found
    report = DocumentReport(document)
    data = check_schema(document, kind, report)
    if body:
        motion = build_motion(data, report, name="imported", body=body)
        if motion and (fast := overspeed(motion, body)):
            found.append(_too_fast(file, fast))
    elif kind == "body":
        build_body(data, report, name="imported")
    elif kind == "controller":
        build_controller(data, report, name="imported")
    else:
        build_machine(data, report, name="imported")
    return [*found, *report.diagnostics]


def _too_fast(file: str, fast: list[Excess]) -> Diagnostic:
    """Return the warning that lint would refuse this motion, with the hint to use --retime."""
    worst = max(fast, key=lambda excess: excess.value / excess.limit)
    others = len({excess.joint for excess in fast}) - 1
    joints = f"`{worst.joint}`" + (f" and {others} other joint{'s' if others > 1 else ''}" if others else "")
    message = f"{joints} would have to move at up to {worst.value / worst.limit:.1f} times the speed limit"
    hint = "use --retime to lengthen the motion"
    return Diagnostic(TOO_FAST, message, Place(file), hint, Severity.WARNING)
