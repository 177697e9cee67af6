"""Where a robot's links are and what they look like, for who draws it: from its joints, by its own model."""

import asyncio
import math
import threading
from collections.abc import AsyncIterator, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import orjson

import lumen
from lumen.console.watch import Watch
from lumen.extras import demand
from lumen.loading.lending import model_files
from lumen.ports import Joints, Sense
from lumen.robots.sense_codec import decode_reading

if TYPE_CHECKING:
    from lumen.language.projects import Project
    from lumen.robots.simulation.link_frames import LinkFrames

PERIOD = 1 / 15
"""How long after a pose the next is sent at the earliest [s]."""
HEARTBEAT = 1.0
DIGITS = 4


class Poses:
    """Poses of the robot of the project in `root`; other robots have models that nobody here knows.

    Raises LumenError where its files have errors, or MuJoCo is not installed.
    """

    def __init__(self, watch: Watch, root: Path) -> None:
        self._watch, self._root = watch, root
        self._links: LinkFrames | None = None
        self._project: Project | None = None
        self._making = threading.Lock()
        self.closing = False

    def shape(self, robot: str) -> dict[str, Any]:
        """The links with their shapes, and the stage [m]; on a thread, for it takes a second."""
        with self._making:
            links, project = self._made()
            found: dict[str, list[dict[str, Any]]] = {}
            for one in links.shapes():
                found.setdefault(one.link, []).append(
                    {
                        "kind": one.kind, "position": _row(one.position), "rotation": _row(one.rotation),
                        "size": _row(one.size), "colour": _row(one.colour),
                        "vertices": np.round(one.vertices, DIGITS).tolist(), "faces": one.faces.tolist(),
                    }
                )  # fmt: skip
        stage = project.stage
        told = {"x": list(stage.x), "y": list(stage.y)} if stage else None
        return {
            "robot": robot,
            "links": [{"name": name, "shapes": rows} for name, rows in found.items()],
            "stage": told,
        }

    async def stream(self, robot: str) -> AsyncIterator[bytes]:
        """Server-sent events `pose` as it moves."""
        seen, view = -1, self._watch.robots[robot]
        waited = 0.0
        while not self.closing:
            if view.moved != seen:
                seen, waited = view.moved, 0.0
                if (links := await asyncio.to_thread(self._pose, view.joints)) is not None:
                    yield b"event: pose\ndata: " + orjson.dumps({"robot": robot, "links": links}) + b"\n\n"
            elif (waited := waited + PERIOD) >= HEARTBEAT:
                waited = 0.0
                yield b":\n\n"
            await asyncio.sleep(PERIOD)

    def _made(self) -> "tuple[LinkFrames, Project]":
        if self._links is None or self._project is None:
            demand("simulation", "the view of the robot in its hall", "mujoco", "dm_control")
            from lumen.robots.simulation.link_frames import LinkFrames

            self._project = lumen.load(self._root)
            self._links = LinkFrames(self._project.body, model_files(self._project)[0])
        return self._links, self._project

    def _pose(self, body: Mapping[str, Any]) -> dict[str, list[float]] | None:
        with self._making:
            links, project = self._made()
            joints = decode_reading(Sense.JOINT, body, tuple(project.body.joints))
            if not isinstance(joints, Joints) or not all(map(math.isfinite, joints.angles)):
                return None
            return dict(_placed(links, joints))


def _placed(links: "LinkFrames", joints: Joints) -> Iterator[tuple[str, list[float]]]:
    """Each link as x, y, z [m] and a rotation w, i, j, k in the hall; parents come before their children."""
    known: dict[str, tuple[Any, Any]] = {}
    for frame in links.frames(joints):
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
