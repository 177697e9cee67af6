"""Import motions of other tools."""

from pathlib import PurePath
from typing import Any, Protocol

from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.robots import Body
from lumen.project.formats.conversion_findings import LOST, ConversionFindings, broken
from lumen.project.formats.importers import reader
from lumen.project.formats.joint_curves import JointCurves, MotionFile
from lumen.project.formats.motion_writer import MotionWriter


class MotionReader(Protocol):
    """Reads the curves of all joints from a file of another tool. Raises ForeignFileError."""

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
