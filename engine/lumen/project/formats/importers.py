"""The importers of other tools' files, by the ending of the file name; they are rows of manifests."""

import logging
from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any, Protocol

from lumen.errors import LumenError
from lumen.feature import Importer, distribution_of, owner, resolve, table
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.robots import Body
from lumen.project.broken_features import faults_reported, faulty, resolved, shown
from lumen.project.formats.conversion_findings import LOST, ConversionFindings, broken
from lumen.project.formats.joint_curves import JointCurves, MotionFile
from lumen.project.formats.known import FormatTable
from lumen.project.formats.motion_writer import MotionWriter


class FileReader(Protocol):
    """Converts a file to the data of one of Lumen's YAML files, and lists what can't be converted.

    `title` is for formats whose files contain no name. Raises ForeignFileError for a file that can't be read.
    """

    def __call__(self, file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]: ...


class RobotReader(Protocol):
    """Converts a model of a robot to the text of a body file, findings about it, and further files by path.

    `output` is where the body file will be, None if it is printed; `title` names the robot. Raises ForeignFileError
    for a file that can't be read.
    """

    def __call__(
        self, path: Path, content: bytes, output: Path | None, title: str
    ) -> tuple[str, list[Diagnostic], dict[Path, bytes]]: ...


def recognised(content: bytes) -> tuple[Importer, Any] | None:
    """Return the row and the function of the importer that recognises a file by its content; None if none does."""
    for ending, row in table("importers").items():
        feature = owner("importers", ending)
        with faults_reported(feature, f"its `{row.begins}`", lambda fault: logging.warning("%s", fault), LumenError):
            if row.begins and resolve(row.begins)(content):
                return row, resolved(feature, row.read)
    return None


def importer(ending: str) -> Importer | None:
    """Return the row for files with that ending, in upper or lower case; None if no importer reads them."""
    found: Importer | None = table("importers").get(ending.lower())
    return found


def endings(kind: str) -> tuple[str, ...]:
    """Return the endings of all files that become a `behavior`, a `controller` or a `motion`."""
    return tuple(ending for ending, row in table("importers").items() if row.kind == kind)


def reader(ending: str) -> Any:
    """Return the function that reads files with that ending, which must have a row.

    Raises LumenError with the name of the package if the package was installed beside Lumen and can't be imported; so
    does the function if it returns something of another type.
    """
    name = ending.lower()
    feature, row = owner("importers", name), table("importers")[name]
    read = resolved(feature, row.read)

    def checked(*arguments: Any, **named: Any) -> Any:
        match row.kind, read(*arguments, **named):
            case "motion", dict() as curves if all(isinstance(points, list) for points in curves.values()):
                return curves
            case "behavior" | "controller", (dict() as data, [*found]) if all(isinstance(d, Diagnostic) for d in found):
                return data, found
            case kind, other:
                meant = "the curves of joints" if kind == "motion" else "data and diagnostics"
                raise faulty(feature, f"`{row.read}` returned {shown(other)} instead of {meant}")

    return checked if distribution_of(feature) else read


def format_tables() -> Mapping[str, FormatTable]:
    """Return each format's table of names: those that are read, lost or meaningless, by the kind of place in a file."""
    return {name: resolved(owner("format_tables", name), where) for name, where in table("format_tables").items()}


class MotionReader(Protocol):
    """Reads the curves of all joints from another tool's file. Raises ForeignFileError for one that can't be read."""

    def __call__(self, file: MotionFile, findings: ConversionFindings) -> JointCurves: ...


def read_gesture(
    file: str, content: bytes, body: Body, *, timeline: str = "", retime: bool = False
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a motion file for that body, and the findings; the file's ending selects the format.

    `timeline` names the timeline of a .xar, or the function of a .py; with `retime` the motion lasts as long as its
    joints need. Raises ForeignFileError if the file holds no motion.
    """
    findings = ConversionFindings()
    read: MotionReader = reader(PurePath(file).suffix)
    curves = read(MotionFile(file, content, timeline, body.hands), findings)
    data = MotionWriter(body, findings, retime).data(curves, f"From {file.replace(chr(92), '/').rpartition('/')[2]}")
    if not data["keyframes"]:
        message = f"the file moves no joint of {body.name}"
        lost = [finding for finding in findings.diagnostics if finding.code == LOST]
        if not lost:
            raise broken(Place(file), "not-a-motion", message)
        raise broken(lost[0].place, "not-a-motion", f"{message}: {lost[0].message}")
    return data, findings.diagnostics
