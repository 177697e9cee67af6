"""The robot for Foxglove: the poses and shapes of its links."""

import math
from collections.abc import Callable, Iterator
from typing import Any

from lumen.errors import LumenError
from lumen.extras import demand
from lumen.features.mcap.files.encoding import nanoseconds
from lumen.features.mcap.files.foxglove import NANO, form_class, foxglove_channel, stamp
from lumen.features.mcap.files.recorded import RecordedMessage
from lumen.language.projects import Project
from lumen.ports import Joints, Message, Sense
from lumen.project.lending import model_files
from lumen.robot.links import BodyLinks, LinkShape, links_of
from lumen.robot.sense_codec import decode_reading

FRAMES, LOOK = ".frames", ".look"
"""The suffixes of the joints' topic for the links' frames and shapes."""


class RobotView:
    """Converts a robot's joint readings to its links' frames.

    Without the extra `simulation` or a model it yields none, and `tell` receives the reason.
    """

    def __init__(self, project: Project, tell: Callable[[str], None] = lambda text: None) -> None:
        self._body, self._topic = project.body, project.key_of(Sense.JOINT)
        self._links: BodyLinks | None = None
        try:
            demand("simulation", "the robot's shape in a recording", "mujoco", "dm_control")
            self._links = links_of(self._body, model_files(project)[0])
        except LumenError as error:
            tell(f"the recording shows no robot: {error}")

    def __call__(self, message: Message, came: float) -> Iterator[RecordedMessage]:
        """Yield the links' frames for a message with finite joint angles; nothing for other messages."""
        if self._links is None or message.key != self._topic:
            return
        joints = decode_reading(Sense.JOINT, message.body, tuple(self._body.joints))
        if not isinstance(joints, Joints) or not all(map(math.isfinite, joints.angles)):
            return
        at, sent = nanoseconds(came), nanoseconds(message.time)
        update = form_class("FrameTransforms")()
        for frame in self._links.frames(joints):
            one = update.transforms.add(parent_frame_id=frame.parent, child_frame_id=frame.name)
            stamp(one.timestamp, at)
            _place(one.translation, one.rotation, frame.position, frame.rotation)
        yield RecordedMessage(
            foxglove_channel(self._topic + FRAMES, "FrameTransforms"), at, sent, update.SerializeToString()
        )

    def look(self, at: float) -> Iterator[RecordedMessage]:
        """Yield a message with the shapes of all links, valid from `at` [s since 1970].

        Without links, nothing is yielded.
        """
        if self._links is None:
            return
        update, entities = form_class("SceneUpdate")(), dict[str, Any]()
        for shape in self._links.shapes():
            if shape.link not in entities:
                entity = entities[shape.link] = update.entities.add(
                    id=shape.link, frame_id=shape.link, frame_locked=True
                )
                stamp(entity.timestamp, int(at * NANO))
            _draw(entities[shape.link], shape)
        when = int(at * NANO)
        channel = foxglove_channel(self._topic + LOOK, "SceneUpdate")
        yield RecordedMessage(channel, when, when, update.SerializeToString())


def _draw(entity: Any, shape: LinkShape) -> None:
    x, y, z = shape.size
    match shape.kind:
        case "mesh":
            found = entity.triangles.add()
            for vertex in shape.vertices:
                found.points.add(x=vertex[0], y=vertex[1], z=vertex[2])
            found.indices.extend(shape.faces.ravel().tolist())
        case "box":
            found = entity.cubes.add()
            _size(found, 2 * x, 2 * y, 2 * z)
        case "cylinder" | "capsule":
            found = entity.cylinders.add(bottom_scale=1.0, top_scale=1.0)
            _size(found, 2 * x, 2 * x, 2 * y)
        case "sphere":
            found = entity.spheres.add()
            _size(found, 2 * x, 2 * x, 2 * x)
        case "ellipsoid":
            found = entity.spheres.add()
            _size(found, 2 * x, 2 * y, 2 * z)
        case _:
            return
    _place(found.pose.position, found.pose.orientation, shape.position, shape.rotation)
    found.color.r, found.color.g, found.color.b, found.color.a = map(float, shape.colour)


def _place(position: Any, rotation: Any, at: Any, turned: Any) -> None:
    position.x, position.y, position.z = at.tolist()
    rotation.w, rotation.x, rotation.y, rotation.z = turned.tolist()


def _size(primitive: Any, x: float, y: float, z: float) -> None:
    primitive.size.x, primitive.size.y, primitive.size.z = float(x), float(y), float(z)
