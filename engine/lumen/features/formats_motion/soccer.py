"""The `.motion` files of teams in RoboCup's 3D simulation league, which call themselves V1.1.

`#WEBOTS_MOTION,V1.1`, then in the same or the second line the joints' names joined by `%`, then a pose per line:
`play%ANGLE%…%DURATION`, in [rad], with the time to reach the pose [s]. There is no specification: this
describes existing files.
"""

from lumen.features.formats_motion.cells import Cell, cells_of
from lumen.language.counts import counted
from lumen.language.diagnostics import Place
from lumen.project.formats.conversion_findings import ConversionFindings, broken
from lumen.project.formats.joint_curves import CurvePoint, JointCurves, number

SOCCER_VERSION = "V1.1"
POSE = "play"


def read_soccer(file: str, text: str, findings: ConversionFindings) -> JointCurves:
    """Return the curves of a motion, joined by lines. Raises ForeignFileError if it has no joint, or one twice."""
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
    """Return how long the movement to the pose of a line takes [s]; None if the line is not a pose."""
    if cells[0][0] != POSE or len(cells) != joints + 2:
        return None
    takes = number(cells[-1][0])
    return takes if takes is not None and takes > 0 else None
