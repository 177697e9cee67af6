"""Motions of other tools, as ours."""

from typing import Any

from lumen.formats.conversion_findings import LOST, ConversionFindings, broken, decoded
from lumen.formats.gestures.choregraphe import choregraphe_list, read_choregraphe
from lumen.formats.gestures.joint_curves import JointCurves
from lumen.formats.gestures.motion_writer import MotionWriter
from lumen.formats.gestures.naoqi import read_naoqi
from lumen.formats.gestures.webots import read_webots
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.robots import Body

GESTURE_ENDINGS = (".motion", ".xar", ".py")

__all__ = ["GESTURE_ENDINGS", "choregraphe_list", "read_gesture"]


def read_gesture(
    file: str, content: bytes, body: Body, *, timeline: str = "", retime: bool = False
) -> tuple[dict[str, Any], list[Diagnostic]]:
    """The data of a motion file for that body, and what could not be carried over; by the file's ending.

    `timeline` names the timeline of a .xar, or the function of a .py; with `retime` the motion lasts as long as its
    joints need. Raises ForeignFileError if the file holds no motion.
    """
    findings = ConversionFindings()
    curves = _curves(file, content, body, findings, timeline)
    data = MotionWriter(body, findings, retime).data(curves, f"From {file.replace(chr(92), '/').rpartition('/')[2]}")
    if not data["keyframes"]:
        message = f"the file moves no joint of {body.name}"
        lost = [finding for finding in findings.diagnostics if finding.code == LOST]
        if not lost:
            raise broken(Place(file), "not-a-motion", message)
        raise broken(lost[0].place, "not-a-motion", f"{message}: {lost[0].message}")
    return data, findings.diagnostics


def _curves(file: str, content: bytes, body: Body, findings: ConversionFindings, timeline: str) -> JointCurves:
    if file.lower().endswith(".xar"):
        return read_choregraphe(file, content, findings, timeline, body.hands)
    text = decoded(file, content)
    return (
        read_naoqi(file, text, findings, timeline)
        if file.lower().endswith(".py")
        else read_webots(file, text, findings)
    )
