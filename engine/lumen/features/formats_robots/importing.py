"""`lumen import` of a robot: convert URDF or MJCF to a body file, and URDF also to the MJCF that it needs."""

import re
from pathlib import Path

from lumen.errors import LumenError
from lumen.extras import MissingExtraError
from lumen.features.formats_robots.reading import read_robot
from lumen.language.diagnostics import Diagnostic, Place, Severity
from lumen.project.formats.conversion_findings import LOST
from lumen.project.formats.xml_elements import XmlElement, parse_xml


def robot_body(
    path: Path, content: bytes, output: Path | None, title: str
) -> tuple[str, list[Diagnostic], dict[Path, bytes]]:
    """Return the body file's text, the findings, and additional files by path.

    A URDF is also converted to MJCF if there is an `output` and MuJoCo is installed. Raises ForeignFileError if the
    file is not a robot.
    """
    urdf = parse_xml(str(path), content).tag == "robot"
    mjcf = path.name if not urdf and path.suffix == ".xml" else f"{title}.xml"
    text, found = read_robot(str(path), content, title, mjcf)
    beside: dict[Path, bytes] = {}
    if output is not None and urdf:
        beside, told = _converted(path, content, output, title)
        found += told
    if not urdf:
        found += _refused(path)
    if output is not None and not urdf and path.resolve() != (output.parent / mjcf).resolve():
        message = f"the body file expects {mjcf} in its own folder, but the model is at {path}"
        hint = f"copy it to {output.parent / mjcf}, with the files that it refers to"
        found.append(Diagnostic(LOST, message, Place(str(path)), hint, Severity.WARNING))
    return text, found, beside


def _converted(path: Path, content: bytes, output: Path, title: str) -> tuple[dict[Path, bytes], list[Diagnostic]]:
    """Return a URDF's MJCF and meshes by path, empty if the conversion fails, and findings about losses."""
    here = Place(str(path), 1, 1)
    try:
        from lumen.features.formats_robots.urdf_conversion import urdf_as_mjcf
    except MissingExtraError as error:
        return {}, [Diagnostic(LOST, f"{title}.xml was not written: {error}", here, "then import the robot again")]
    try:
        robot = urdf_as_mjcf(content, path.parent, title)
    except LumenError as error:
        hint = f"correct the URDF, or write models/{title}.xml by hand; the body file is written anyway"
        return {}, [Diagnostic(LOST, f"{title}.xml was not written: {error}", here, hint)]
    places = [element for element in parse_xml(str(path), content).walk() if element.tag == "mesh"]
    lost = [_without(places[number], reason) for number, reason in robot.lost.items()]
    folder = output.parent
    text = robot.mjcf.replace("<compiler ", f'<compiler meshdir="{title}" ', 1) if robot.meshes else robot.mjcf
    beside = {folder / f"{title}.xml": text.encode()}
    return beside | {folder / title / name: mesh for name, mesh in robot.meshes.items()}, lost


def _refused(path: Path) -> list[Diagnostic]:
    """Return MuJoCo's error about an MJCF as a finding; empty if it is valid or MuJoCo is not installed."""
    try:
        from lumen.features.formats_robots.urdf_conversion import mjcf_fault
    except MissingExtraError:
        return []
    fault = mjcf_fault(path)
    line = re.search(r"\bline (\d+)", fault)
    place = Place(str(path), int(line.group(1)) if line else 1, 1)
    return [Diagnostic(LOST, f"MuJoCo can't build it: {fault}", place, "correct the model")] if fault else []


def _without(mesh: XmlElement, reason: str) -> Diagnostic:
    message = f"the mesh `{mesh.get('filename')[:80]}` is left out: {reason}"
    return Diagnostic(LOST, message, mesh.place, "put it there as STL or OBJ, then import again")
