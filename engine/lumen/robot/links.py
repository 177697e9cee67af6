"""The poses and shapes of a robot's links for given joint angles; a feature computes both."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

from lumen.errors import RobotError
from lumen.feature import rows
from lumen.language.robots import Body
from lumen.ports import Joints
from lumen.project.broken_features import called

if TYPE_CHECKING:  # numpy takes longer to import than most commands
    import numpy as np
    from numpy.typing import NDArray

FLOOR = "hall"
"""The parent frame of the first link: the place where the robot started, z up."""


class LinkFrame(NamedTuple):
    """A link in the frame of its parent."""

    name: str
    parent: str
    position: "NDArray[np.float64]"
    """The position [m]."""
    rotation: "NDArray[np.float64]"
    """The rotation, a quaternion (w, x, y, z)."""


class LinkShape(NamedTuple):
    """The visible shape of a link, in its frame: a box, ellipsoid, cylinder or capsule, or triangles."""

    link: str
    kind: str
    position: "NDArray[np.float64]"
    rotation: "NDArray[np.float64]"
    size: "NDArray[np.float64]"
    """The half sizes [m]; of a capsule and a cylinder the radius and half the length along z."""
    colour: "NDArray[np.float64]"
    """Red, green, blue and alpha."""
    vertices: "NDArray[np.float64]"
    faces: "NDArray[np.int32]"


class BodyLinks(Protocol):
    """The links of one body."""

    def frames(self, joints: Joints) -> Iterator[LinkFrame]:
        """Yield each link in its parent's frame, the first one in the hall's: its lowest point is on the floor."""
        ...

    def shapes(self) -> Iterator[LinkShape]:
        """Yield the visible shapes of the links."""
        ...


def links_of(body: Body, models: Path) -> BodyLinks:
    """Return the links of a body whose model is in the folder `models`.

    Raises LumenError if no feature computes them, if a needed package is not installed, or if the model can't be built.
    """
    for feature, where in rows("links"):
        links: BodyLinks = called(feature, where, body, models)
        return links
    raise RobotError("no feature computes where the links of a robot are")
