"""Converts a robot's URDF to MJCF with MuJoCo's own compiler, without meshes that MuJoCo can't read."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from lumen.errors import RobotModelError
from lumen.extras import demand

demand("simulation", "MuJoCo's model of an imported robot", "mujoco")

import mujoco  # noqa: E402  if it is installed

READ = (".stl", ".obj", ".msh")
"""The file extensions of meshes that MuJoCo reads."""

MAX_MESH_BYTES = 50_000_000
"""The largest mesh [bytes]; larger ones are left out."""

_COMPILER = {
    "strippath": "true", "discardvisual": "false", "fusestatic": "false", "balanceinertia": "true",
    "boundmass": "0.001", "boundinertia": "0.0000001",
}  # fmt: skip
_SEEN, _TOUCHING = 2, 3
"""The geom groups of visible and colliding shapes, as in Lumen's own models."""


@dataclass(frozen=True)
class ConvertedRobot:
    """A URDF converted to MJCF, with its meshes."""

    mjcf: str
    meshes: Mapping[str, bytes]
    """The meshes that the MJCF refers to, by their new names."""
    lost: Mapping[int, str]
    """The reasons why other meshes are lost, by their index in the URDF."""


def urdf_as_mjcf(content: bytes, folder: Path, name: str) -> ConvertedRobot:
    """Convert a URDF, which must be XML without entities; meshes are searched for, starting from `folder`.

    A mesh that is missing, too large or in an unknown format is left out with its shape. Raises RobotModelError if
    MuJoCo can't build the rest.
    """
    root = ElementTree.fromstring(content)
    meshes, lost = _take_meshes(root, folder)
    for old in root.findall("mujoco"):
        root.remove(old)
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", _COMPILER)
    root.set("name", name)
    try:
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"), assets=dict(meshes))
        _sort_geoms(spec)
        spec.compile()
        text = spec.to_xml()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        raise RobotModelError(f"MuJoCo cannot build it: {reason[:200]}") from error
    return ConvertedRobot(text, meshes, lost)


def mjcf_fault(path: Path) -> str:
    """Return the reason why MuJoCo can't build the robot in an MJCF file; empty if it can."""
    try:
        mujoco.MjSpec.from_file(str(path)).compile()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        return " ".join(str(error).split())[:200]
    return ""


def _sort_geoms(spec: mujoco.MjSpec) -> None:
    """Sort visible and colliding shapes into Lumen's geom groups; let colliding ones touch objects in a hall."""
    for body in spec.bodies:
        seen = [geom for geom in body.geoms if not (geom.contype or geom.conaffinity)]
        for geom in body.geoms:
            geom.group = _TOUCHING if seen and geom not in seen else _SEEN
            if geom not in seen:
                geom.conaffinity = 3


def _take_meshes(root: ElementTree.Element, folder: Path) -> tuple[dict[str, bytes], dict[int, str]]:
    """Rename the meshes in the URDF, and remove the shapes of unavailable ones.

    Return the meshes by new name, and the reasons for losses by index.
    """
    meshes, lost, names = dict[str, bytes](), dict[int, str](), dict[Path, str]()
    numbers = {mesh: number for number, mesh in enumerate(root.iter("mesh"))}
    for link in list(root.iter("link")):
        for shape in [child for child in link if child.tag in ("visual", "collision")]:
            for mesh in shape.iter("mesh"):
                path, reason = _found(mesh.get("filename", ""), folder)
                if path is None:
                    lost[numbers[mesh]] = reason
                    link.remove(shape)
                    break
                if path not in names:
                    stem = re.sub(r"[^A-Za-z0-9_]+", "_", path.stem) or "mesh"
                    names[path] = _unused(stem, path.suffix.lower(), meshes)
                    meshes[names[path]] = path.read_bytes()
                mesh.set("filename", names[path])
    return meshes, lost


def _found(filename: str, folder: Path) -> tuple[Path | None, str]:
    """Return the path of a URDF's mesh, or None and the reason why it is unavailable."""
    inner = re.sub(r"^(package|file|model)://", "", filename).lstrip("/")
    ending = Path(inner).suffix.lower()
    if not inner or "\0" in inner:
        return None, "it names no file"
    if ending not in READ:
        return None, f"MuJoCo reads {', '.join(READ)}, not `{ending or 'a file without an ending'}`"
    for path in _candidates(inner, folder):
        try:
            if path.is_file() and path.stat().st_size <= MAX_MESH_BYTES:
                return path.resolve(), ""
        except OSError:
            continue
    return None, "there is no such file in this folder, in `meshes/`, or in a folder above"


def _candidates(inner: str, folder: Path) -> Iterator[Path]:
    """Yield possible paths of a mesh in the URDF's folder and up to four folders above it.

    Each path is tried as written, and without its first one or two folders. The last ones are the bare file name in
    `meshes/` and beside the URDF.
    """
    here = folder.resolve()
    parts = [part for part in Path(inner).parts if part != ".."]
    for above in (here, *list(here.parents)[:4]):
        for start in range(min(len(parts), 3)):
            yield above.joinpath(*parts[start:])
    yield here / "meshes" / parts[-1]
    yield here / parts[-1]


def _unused(stem: str, ending: str, names: Mapping[str, bytes]) -> str:
    number, name = 1, stem + ending
    while name in names:
        number += 1
        name = f"{stem}_{number}{ending}"
    return name
