"""Webots' `.motion` files: a line of joint names, then a pose per line.

Webots' reference manual, "Motion": `#WEBOTS_MOTION,V1.0,JOINT,…`, then `MM:SS:mmm,NAME,ANGLE,…` in [rad], with `*` for
a joint that does not move. Teams of RoboCup's 3D league write V1.1 (`soccer.py`), which Webots does not support.
"""

import re

from lumen.features.formats_motion.cells import Cell, cells_of
from lumen.features.formats_motion.soccer import SOCCER_VERSION, read_soccer
from lumen.language.counts import counted
from lumen.language.diagnostics import Place
from lumen.project.formats.conversion_findings import ConversionFindings, broken, decoded
from lumen.project.formats.joint_curves import CurvePoint, JointCurves, MotionFile, number
from lumen.project.formats.known import FormatTable, Known

FIRST_CELL = "#WEBOTS_MOTION"
"""The first word of every file."""

WEBOTS_VERSION = "V1.0"

KNOWN: FormatTable = {
    "first line": Known(frozenset(("#WEBOTS_MOTION", "V1.0", "V1.1", "joint"))),
    "pose": Known(frozenset(("time", "angle", "*")), lost={"name": "keyframes in Lumen have no names"}),
}
"""The parts of a `.motion` that are carried over: the cells of its lines, by kind."""

_TIME = re.compile(r"(?:(?:(\d{1,6}):)?(\d{1,6}):)?(\d{1,9})", re.ASCII)
_PLAIN_NAME = re.compile(r"pose\s*_?\d*", re.IGNORECASE)


def read_webots(file: MotionFile, findings: ConversionFindings) -> JointCurves:
    """Return the curves of a motion, joined by lines. Raises ForeignFileError if it is not a motion."""
    text = decoded(file.name, file.content)
    lines = list(cells_of(file.name, text, ","))
    if lines and [word for word, _ in lines[0][:2]] == [FIRST_CELL, SOCCER_VERSION]:
        return read_soccer(file.name, text, findings)
    joints = _joints(file.name, lines)
    curves: dict[str, list[CurvePoint]] = {joint: [] for joint, _ in joints}
    renamed = False
    for cells in lines:
        time = _time(cells[0][0])
        if time is None or len(cells) != len(joints) + 2:
            wanted = "a time such as 00:01:500" if time is None else f"a name and {counted(len(joints), 'angle')}"
            findings.lost(cells[0][1], f"this line can't be read: write {wanted}")
            continue
        if not renamed and not _PLAIN_NAME.fullmatch(cells[1][0]):
            findings.changed(cells[1][1], "the names of poses are left out: keyframes in Lumen have no names")
            renamed = True
        for (joint, _), (word, place) in zip(joints, cells[2:], strict=True):
            angle = number(word)
            if angle is not None:
                curves[joint].append(CurvePoint(time, angle, place, straight=True))
            elif word != "*":
                findings.lost(
                    place, f"`{word}` is not an angle", "write a number in rad, or * to leave the joint alone"
                )
    return {joint: points for joint, points in curves.items() if points}


def _joints(file: str, lines: list[list[Cell]]) -> list[Cell]:
    """Remove the joints from the front of the lines and return them; some tools write their names into the second
    line.
    """
    head = lines.pop(0) if lines else []
    if not head or head[0][0] != FIRST_CELL:
        raise broken(Place(file), "not-a-motion", f"this is not a Webots motion: it does not begin with {FIRST_CELL}")
    if len(head) < 2 or head[1][0] != WEBOTS_VERSION:
        said = head[1][0] if len(head) > 1 else "nothing"
        raise broken(
            head[-1][1],
            "not-a-motion",
            f"unknown version {said}: only {WEBOTS_VERSION} and {SOCCER_VERSION} can be read",
        )
    joints = [cell for cell in head[2:] if cell[0]]
    if not joints and lines and _time(lines[0][0][0]) is None:
        joints = [cell for cell in lines.pop(0) if cell[0]]
    names = [name for name, _ in joints]
    if not joints:
        raise broken(head[0][1], "not-a-motion", "the first line contains no joint names")
    if twice := next((cell for i, cell in enumerate(joints) if cell[0] in names[:i]), None):
        raise broken(twice[1], "not-a-motion", f"the joint `{twice[0]}` is listed twice")
    return joints


def _time(text: str) -> float | None:
    """Return the time of a pose [s] as Webots reads it: minutes and seconds may be missing, milliseconds are a
    number.
    """
    match = _TIME.fullmatch(text)
    return int(match[1] or 0) * 60.0 + int(match[2] or 0) + int(match[3]) / 1000.0 if match else None
