"""Reads Webots' `.motion` files, which contain a line of joint names, then a pose per line.

V1.0 (Webots' reference manual, "Motion") is `#WEBOTS_MOTION,V1.0,JOINT,…`, then `MM:SS:mmm,NAME,ANGLE,…`, with angles
in [rad], or `*` for a joint that does not move.

V1.1 is written by teams of RoboCup's 3D league, and not supported by Webots. After `#WEBOTS_MOTION,V1.1`, the joint
names follow on the same or the second line, joined by `%`. A pose is `play%ANGLE%…%DURATION`, with angles in [rad] and
the time to reach it in [s]. There is no specification: this describes existing files.
"""

import re
from collections.abc import Iterator

from lumen.language.counts import counted
from lumen.language.diagnostics import Place
from lumen.language.text_lines import lines_of
from lumen.project.formats.conversion_findings import ConversionFindings, broken, decoded
from lumen.project.formats.joint_curves import CurvePoint, JointCurves, MotionFile, number
from lumen.project.formats.known import FormatTable, Known

Cell = tuple[str, Place]


def cells_of(file: str, text: str, separator: str) -> Iterator[list[Cell]]:
    """Yield the cells of each line that is not empty, without surrounding whitespace."""
    for i, line in enumerate(lines_of(text), 1):
        if line.strip():
            yield list(_cells(file, i, line, separator))


def _cells(file: str, row: int, line: str, separator: str) -> Iterator[Cell]:
    column = 1
    for cell in line.split(separator):
        begin = column + len(cell) - len(cell.lstrip())
        word = cell.strip()
        yield word, Place(file, row, begin, row, begin + max(len(word), 1))
        column += len(cell) + 1


SOCCER_VERSION = "V1.1"
POSE = "play"


def read_soccer(file: str, text: str, findings: ConversionFindings) -> JointCurves:
    """Return the curves of a V1.1 motion, linear between poses; report invalid lines.

    Raises ForeignFileError if the motion has no joint or repeats one.
    """
    (first, *rest), *lines = cells_of(file, text, "%")
    behind = first[0].partition(SOCCER_VERSION)[2].lstrip(", ")
    row = [(behind, first[1]), *rest] if behind else lines.pop(0) if lines else []
    joints = [cell for cell in row if cell[0]]
    if not joints:
        raise broken(Place(file), "not-a-motion", "the first two lines contain no joint names")
    names = [name for name, _ in joints]
    if twice := next((cell for i, cell in enumerate(joints) if cell[0] in names[:i]), None):
        raise broken(twice[1], "not-a-motion", f"the joint `{twice[0]}` is listed twice")
    curves: dict[str, list[CurvePoint]] = {name: [] for name in names}
    time = 0.0
    for cells in lines:
        takes = _takes(cells, len(joints))
        if takes is None:
            wanted = f"`{POSE}%`, {counted(len(joints), 'angle')} and a time above 0 s, separated by `%`"
            findings.lost(cells[0][1], f"this line can't be read: write {wanted}")
            continue
        time += takes
        for name, (word, place) in zip(names, cells[1:-1], strict=True):
            angle = number(word)
            if angle is None:
                findings.lost(place, f"`{word}` is not an angle", "write a number in rad")
            else:
                curves[name].append(CurvePoint(time, angle, place, straight=True))
    return {joint: points for joint, points in curves.items() if points}


def _takes(cells: list[Cell], joints: int) -> float | None:
    """Return the duration of the movement to a line's pose [s], or None if the line is not a valid pose."""
    if cells[0][0] != POSE or len(cells) != joints + 2:
        return None
    takes = number(cells[-1][0])
    return takes if takes is not None and takes > 0 else None


FIRST_CELL = "#WEBOTS_MOTION"
"""The first cell of every file."""

WEBOTS_VERSION = "V1.0"

KNOWN: FormatTable = {
    "first line": Known(frozenset(("#WEBOTS_MOTION", "V1.0", "V1.1", "joint"))),
    "pose": Known(frozenset(("time", "angle", "*")), lost={"name": "keyframes in Lumen have no names"}),
}
"""The cells of a `.motion` that are read or lost, by kind of line."""

_TIME = re.compile(r"(?:(?:(\d{1,6}):)?(\d{1,6}):)?(\d{1,9})", re.ASCII)
_PLAIN_NAME = re.compile(r"pose\s*_?\d*", re.IGNORECASE)


def read_webots(file: MotionFile, findings: ConversionFindings) -> JointCurves:
    """Return a motion's curves, linear between poses. Raises ForeignFileError if the file is not a motion."""
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
    """Remove the heading from the lines and return its joints, which some tools write into the second line.

    Raises ForeignFileError if the heading is invalid.
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
    """Return a pose's time [s] as Webots reads it; None for any other text.

    Minutes and seconds can be missing, and milliseconds have up to nine digits.
    """
    match = _TIME.fullmatch(text)
    return int(match[1] or 0) * 60.0 + int(match[2] or 0) + int(match[3]) / 1000.0 if match else None
