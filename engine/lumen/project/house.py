"""Read `robot:` or `robots:` of lumen.yaml as the robots that perform, and `places:` as the places of the hall."""

import re
from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.hall_places import DEFAULT_WITHIN, HallPlace, HallPlaces
from lumen.language.house import DEFAULT_SPACING, RobotSpec, StartPose
from lumen.project.complaints import MISSING_KEY
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import finite
from lumen.project.sections import read_fields
from lumen.project.units import ANGLES, LENGTHS

DEFAULT_ROBOT = "NAO"
ROBOTS_TWICE = Code("robots-twice", "robot", ERROR, "lumen.yaml has both `robot` and `robots`")

HOW = "write `robot: {name: NAO, model: nao}` for one robot, or `robots:` with a line for each of several robots"


def build_robots(data: Mapping[str, Any], report: DocumentReport) -> dict[str, RobotSpec]:
    """Return the robots of `robots:` by name, in the order written, or else the one of `robot:`.

    A file with both keys, or with neither, is reported. Without either, the result is one robot with default settings.
    """
    several = data.get("robots")
    if "robot" in data and several:
        report(ROBOTS_TWICE, ("robots",), "`robot` and `robots` are both set", f"delete one of them: {HOW}", key=True)
    if "robot" not in data and not several and not any(path[:1] in (("robot",), ("robots",)) for path in report.pruned):
        report(MISSING_KEY, (), "`robot` is missing", HOW)
    if not several:
        row = data.get("robot", {})
        one = _spec(row.get("name", DEFAULT_ROBOT), row, data, StartPose())
        return {one.name: one}
    found = {}
    for i, (name, row) in enumerate(several.items()):
        found[name] = _spec(name, row, data, _pose(data, ("robots", name, "at"), i, report))
    return found


def build_house(data: Mapping[str, Any]) -> str:
    """Return `house` of lumen.yaml; else the project's name as a word of a routing key, or "house" without a name."""
    return data.get("house", "") or re.sub(r"[^a-z0-9]+", "-", data.get("name", "").lower()).strip("-") or "house"


def robot_names(data: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the robots that `build_robots` builds, in the order written."""
    return tuple(data.get("robots") or (data.get("robot", {}).get("name", DEFAULT_ROBOT),))


def told_robots(data: Mapping[str, Any]) -> bool:
    """Return True if lumen.yaml has `robots:`; then robots are distinguished by name, even on the disk."""
    return bool(data.get("robots"))


def _spec(name: str, row: Mapping[str, Any], data: Mapping[str, Any], at: StartPose) -> RobotSpec:
    common = {key: data[key] for key in ("behavior", "languages", "story") if key in data}
    return read_fields(RobotSpec, {**common, **row}, name=name, at=at)


def _pose(data: Mapping[str, Any], where: NodePath, index: int, report: DocumentReport) -> StartPose:
    row, units = data["robots"][where[1]].get("at"), data.get("units", {})
    if row is None:
        return StartPose(y=DEFAULT_SPACING * (index - (len(data["robots"]) - 1) / 2))
    if not all(finite(value, report, (*where, key)) for key, value in row.items()):
        return StartPose(y=DEFAULT_SPACING * (index - (len(data["robots"]) - 1) / 2))
    length, angle = LENGTHS[units.get("length", "m")], ANGLES[units.get("angle", "deg")]
    return StartPose(row.get("x", 0.0) * length, row.get("y", 0.0) * length, row.get("facing", 0.0) * angle)


def read_hall_places(data: Mapping[str, Any], report: DocumentReport) -> HallPlaces:
    """Return the places in SI units, without those with an infinite number or NaN, which are reported.

    Headings are in degrees if the file names no unit of angles.
    """
    units = data.get("units", {})
    length, angle = LENGTHS[units.get("length", "m")], ANGLES[units.get("angle", "deg")]
    found = {}
    for name, row in data["places"].items():
        if not all(finite(value, report, ("places", name, key)) for key, value in row.items()):
            continue
        found[name] = HallPlace(
            x=row["x"] * length,
            y=row["y"] * length,
            heading=row["heading"] * angle if "heading" in row else None,
            within=row["within"] * length if "within" in row else DEFAULT_WITHIN,
        )
    return HallPlaces(found)
