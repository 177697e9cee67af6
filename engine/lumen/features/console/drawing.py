"""The shapes and poses of a robot's links, computed from its joint angles and its project's model."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import lumen
from lumen.extras import demand
from lumen.ports import Joints, Sense
from lumen.project.lending import model_files
from lumen.robot.links import links_of
from lumen.robot.sense_codec import decode_reading

DIGITS = 4


class Drawing:
    """Draws the named robot of the project in `root`, or its first robot if the name is empty.

    Raises LumenError if the project has errors or MuJoCo is not installed.
    """

    def __init__(self, root: Path, robot: str = "") -> None:
        demand("simulation", "the view of the robot in its hall", "mujoco", "dm_control")
        self._project = lumen.load(root, robot=robot)
        self._links = links_of(self._project.body, model_files(self._project)[0])

    def shape(self) -> dict[str, Any]:
        """Return the links with their shapes, and the stage (null if there is none), as JSON data in metres."""
        found: dict[str, list[dict[str, Any]]] = {}
        for one in self._links.shapes():
            found.setdefault(one.link, []).append(
                {
                    "kind": one.kind, "position": _row(one.position), "rotation": _row(one.rotation),
                    "size": _row(one.size), "colour": _row(one.colour),
                    "vertices": np.round(one.vertices, DIGITS).tolist(), "faces": one.faces.tolist(),
                }
            )  # fmt: skip
        stage = self._project.stage
        return {
            "robot": self._project.robot,
            "links": [{"name": name, "shapes": rows} for name, rows in found.items()],
            "stage": {"x": list(stage.x), "y": list(stage.y)} if stage else None,
        }

    def pose(self, body: Any) -> dict[str, list[float]] | None:
        """Return each link's position x, y, z [m] and quaternion w, x, y, z in the hall, by name.

        Return None if `body` has no valid joint angles.
        """
        if not isinstance(body, Mapping):
            return None
        joints = decode_reading(Sense.JOINT, body, tuple(self._project.body.joints))
        if not isinstance(joints, Joints) or not all(map(math.isfinite, joints.angles)):
            return None
        return dict(self._placed(joints))

    def _placed(self, joints: Joints) -> Iterator[tuple[str, list[float]]]:
        """Yield each link's name and pose. The frames of parents precede those of their children."""
        known: dict[str, tuple[Any, Any]] = {}
        for frame in self._links.frames(joints):
            position, rotation = np.asarray(frame.position), np.asarray(frame.rotation)
            if frame.parent in known:
                before, turned = known[frame.parent]
                position, rotation = before + _turn(turned, position), _product(turned, rotation)
            known[frame.name] = position, rotation
            yield frame.name, [*_row(position), *_row(rotation)]


def _turn(q: Any, v: Any) -> Any:
    return v + 2.0 * np.cross(q[1:], np.cross(q[1:], v) + q[0] * v)


def _product(a: Any, b: Any) -> Any:
    w = a[0] * b[0] - a[1:] @ b[1:]
    return np.concatenate(([w], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])))


def _row(values: Any) -> list[float]:
    return [round(float(value), DIGITS) for value in values]
