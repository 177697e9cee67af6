"""The NAO's shells: lofts through superellipses, written as OBJ files into the folder of its MJCF.

    python -m lumen.features.simulation.shells models/nao

They affect only the robot's looks. Proportions follow the published dimensions (link lengths, sensor positions, the
sole's outline). Coordinates are in the link's frame [mm].
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Vertices = NDArray[np.float64]
CrossSection = tuple[float, float, float, float, float, float]
"""A section: position along the axis, centre (x, y) of the ring and half widths (x, y) [mm], and exponent.

An exponent of 2 gives an ellipse; larger exponents approach a box.
"""

SEGMENTS, BLEND_STEPS = 28, 3


@dataclass(frozen=True)
class Loft:
    """A skin around sections along z, or along x with `axis="x"`.

    With `axis="x"`, a ring's x coordinate becomes -z, and its y coordinate stays y.
    """

    sections: Sequence[CrossSection]
    axis: str = "z"

    def skin(self, s: Vertices, theta: Vertices, offset: float = 0.0) -> Vertices:
        """Return points `offset` [mm] outside the skin, Shape (s, theta, 3).

        They are at the shares `s` (0..1) of the length and the angles `theta` [rad].
        """
        along, cx, cy, a, b, n = _through(np.array(self.sections), s).T[:, :, None]
        c, d = np.cos(theta)[None], np.sin(theta)[None]
        power = 2.0 / np.maximum(n, 1.0)
        u = cx + (np.maximum(a, 0.0) + offset) * np.sign(c) * np.abs(c) ** power
        v = cy + (np.maximum(b, 0.0) + offset) * np.sign(d) * np.abs(d) ** power
        w = np.broadcast_to(along, u.shape)
        points = (u, v, w) if self.axis == "z" else (w, v, -u)
        return np.stack(points, axis=-1)

    def mesh(self) -> tuple[Vertices, NDArray[np.int64]]:
        """Return the vertices [mm] and triangles of the whole skin, closed at both ends: Shape (n, 3) each."""
        s = np.linspace(0, 1, BLEND_STEPS * (len(self.sections) - 1) + 1)
        theta = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
        grid = self.skin(s, theta)
        ends = grid[[0, -1]].mean(axis=1)
        vertices = np.concatenate([grid.reshape(-1, 3), ends])
        faces = _quads(len(s), SEGMENTS, wrap=True)
        first, last, rim = len(vertices) - 2, len(vertices) - 1, (len(s) - 1) * SEGMENTS
        k = np.arange(SEGMENTS)
        after = (k + 1) % SEGMENTS
        bottom = np.stack([np.full(SEGMENTS, first), after, k], axis=1)
        top = np.stack([np.full(SEGMENTS, last), rim + k, rim + after], axis=1)
        return vertices, np.concatenate([faces, bottom, top])


@dataclass(frozen=True)
class ShellPanel:
    """A slab that covers part of a loft's skin."""

    loft: Loft
    span: tuple[float, float]
    """The shares of the loft's length at which the slab begins and ends."""
    arc: tuple[float, float]
    """The angles at which the slab begins and ends [deg]."""
    rise: float = 1.0
    """The slab's height above the skin [mm]."""
    sink: float = 1.5
    """The slab's depth below the skin [mm]."""

    def mesh(self) -> tuple[Vertices, NDArray[np.int64]]:
        """Return the vertices [mm] and triangles of a closed slab: Shape (n, 3) each."""
        s = np.linspace(*self.span, 14)
        theta = np.radians(np.linspace(*self.arc, max(6, round((self.arc[1] - self.arc[0]) / 8))))
        outer, inner = self.loft.skin(s, theta, self.rise), self.loft.skin(s, theta, -self.sink)
        rows, columns = outer.shape[:2]
        vertices = np.concatenate([outer.reshape(-1, 3), inner.reshape(-1, 3)])
        skin, count = _quads(rows, columns, wrap=False), rows * columns
        index = np.arange(count).reshape(rows, columns)
        rim = np.concatenate([index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]])
        after = np.roll(rim, -1)
        sides = np.concatenate(
            [np.stack([rim, rim + count, after], axis=1), np.stack([after, rim + count, after + count], axis=1)]
        )
        return vertices, np.concatenate([skin, skin[:, ::-1] + count, sides])


@dataclass(frozen=True)
class Ring:
    """A torus around z with a radius of 1000 mm, to be scaled in the MJCF."""

    thick: float
    """Half the ring's radial thickness [mm]."""
    flat: float
    """Half the ring's thickness along z [mm]."""

    def mesh(self) -> tuple[Vertices, NDArray[np.int64]]:
        """Return the vertices [mm] and triangles of the torus: Shape (n, 3) each."""
        around, across = np.linspace(0, 2 * np.pi, 32, endpoint=False), np.linspace(0, 2 * np.pi, 8, endpoint=False)
        radius = 1000 + self.thick * np.cos(across)[:, None]
        x, y = radius * np.cos(around), radius * np.sin(around)
        z = np.broadcast_to(self.flat * np.sin(across)[:, None], x.shape)
        grid = np.stack([x, y, z], axis=-1)
        return grid.reshape(-1, 3), _quads(9, 32, wrap=True) % (8 * 32)


def _through(sections: Vertices, s: Vertices) -> Vertices:
    """Return the sections interpolated at the shares `s` (0..1) by a Catmull-Rom spline: Shape (len(s), columns)."""
    position = s * (len(sections) - 1)
    i = np.minimum(position.astype(int), len(sections) - 2)
    t = (position - i)[:, None]
    padded = np.concatenate([2 * sections[:1] - sections[1:2], sections, 2 * sections[-1:] - sections[-2:-1]])
    p0, p1, p2, p3 = (padded[i + k] for k in range(4))
    curve: Vertices = p1 + 0.5 * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)))
    return curve


def _quads(rows: int, columns: int, wrap: bool) -> NDArray[np.int64]:
    """Return the triangles of a grid of points, counterclockwise as seen from outside.

    `wrap` joins the last column to the first.
    """
    count = columns if wrap else columns - 1
    r, c = (index.ravel() for index in np.meshgrid(np.arange(rows - 1), np.arange(count), indexing="ij"))
    a, b = r * columns + c, r * columns + (c + 1) % columns
    d, e = a + columns, b + columns
    return np.concatenate([np.stack([a, b, e], axis=1), np.stack([a, e, d], axis=1)])


HEAD_SHELL = Loft((
    (-9, 0, 0, 26, 27, 2.2), (-4, 2, 0, 38, 37, 2.3), (8, 4, 0, 49, 47, 2.4), (24, 3, 0, 56, 55, 2.5),
    (44, 1, 0, 59.5, 60, 2.5), (62, 0, 0, 60, 60.5, 2.4), (80, -2, 0, 56.5, 55, 2.3), (95, -4, 0, 46, 43, 2.2),
    (105, -5, 0, 30, 28, 2.1), (110, -5, 0, 12, 11, 2.0), (110.8, -5, 0, 2, 2, 2.0),
))  # fmt: skip
TORSO_SHELL = Loft((
    (-92, -14, 0, 20, 26, 2.3), (-84, -13, 0, 32, 37, 2.4), (-62, -11, 0, 41, 45, 2.5), (-30, -8, 0, 45, 49, 2.5),
    (5, -5, 0, 50, 56, 2.6), (40, -4, 0, 55, 65, 2.7), (72, -5, 0, 56, 70, 2.8), (96, -7, 0, 49, 66, 2.6),
    (110, -8, 0, 38, 50, 2.4), (120, -8, 0, 24, 30, 2.2), (123, -8, 0, 12, 15, 2.0),
))  # fmt: skip
UPPER_ARM_SHELL = Loft((
    (-24, 0, 4, 12, 12, 2.0), (-18, 0, 4, 23, 22, 2.1), (-4, 0, 5, 30, 28, 2.3), (20, 0, 7, 31, 28, 2.4),
    (46, 0, 10, 28, 25.5, 2.4), (70, 0, 12, 25, 23, 2.3), (84, 0, 13, 20, 19, 2.2), (90, 0, 13, 12, 12, 2.0),
), axis="x")  # fmt: skip
FOREARM_SHELL = Loft((
    (-22, 0, 0, 8, 8, 2.0), (-16, 0, 0, 19, 18, 2.2), (-2, 0, 0, 24.5, 24, 2.4), (18, 0, 1, 26.5, 26, 2.5),
    (38, 0, 1, 26, 25.5, 2.5), (54, 0, 0, 23.5, 23, 2.5), (60, 0, 0, 18, 18, 2.2),
), axis="x")  # fmt: skip
HAND_SHELL = Loft((
    (14, 0, 0, 14, 16, 2.2), (22, 1, 0, 19, 21, 2.4), (40, 1, 0, 19.5, 24, 2.6), (58, -1, 0, 16, 24, 2.7),
    (70, -2, 0, 12, 22, 2.6), (75, -2, 0, 7, 16, 2.4),
), axis="x")  # fmt: skip
FINGER_SHELL = Loft((
    (-3, 0, 0, 4, 4.5, 2.0), (2, 0, 0, 7.5, 7.5, 2.2), (18, 0.5, 0, 7.2, 7.2, 2.3), (30, 1.5, 0, 6.4, 6.6, 2.3),
    (36, 2.4, 0, 4.6, 5, 2.1), (38.5, 3, 0, 2, 2, 2.0),
), axis="x")  # fmt: skip
THIGH_SHELL = Loft((
    (-124, 3, 1, 14, 16, 2.2), (-118, 4, 1, 26, 25, 2.3), (-102, 5, 1, 34, 31, 2.4), (-80, 5, 2, 36, 34, 2.5),
    (-52, 4, 4, 39, 38, 2.6), (-24, 2, 6, 38, 37, 2.6), (-4, 0, 7, 33, 33, 2.5), (10, -1, 7, 24, 25, 2.3),
    (17, -1, 7, 10, 11, 2.0),
))  # fmt: skip
TIBIA_SHELL = Loft((
    (-99, 4, 1, 22, 24, 2.3), (-94, 4, 1, 28, 29, 2.4), (-78, 3, 2, 34, 34, 2.6), (-52, 0, 2, 39, 37, 2.6),
    (-28, -2, 2, 39, 36, 2.6), (-8, -2, 1, 33, 32, 2.4), (8, -1, 1, 22, 24, 2.2), (14, -1, 1, 9, 11, 2.0),
))  # fmt: skip
FOOT_SHELL = Loft((
    (-45.1, 24.5, 5.5, 71, 40, 2.9), (-43, 24.5, 5.5, 74.5, 43.5, 2.9), (-34, 24.5, 5.5, 75, 44, 2.8),
    (-24, 22, 5, 71, 41.5, 2.7), (-13, 15, 4, 60, 38, 2.5), (-2, 7, 3, 46, 34, 2.4), (8, 1, 2, 34, 29, 2.3),
    (14, -1, 2, 22, 20, 2.1), (16, -1, 2, 10, 9, 2.0),
))  # fmt: skip

SHELLS: dict[str, Loft | ShellPanel | Ring] = {
    "head": HEAD_SHELL,
    "crown_left": ShellPanel(HEAD_SHELL, (0.30, 0.86), (48, 132)),
    "nape": ShellPanel(HEAD_SHELL, (0.18, 0.80), (132, 228)),
    "brow": ShellPanel(HEAD_SHELL, (0.60, 0.97), (-22, 22)),
    "torso": TORSO_SHELL,
    "flank_left": ShellPanel(TORSO_SHELL, (0.30, 0.86), (38, 150)),
    "pelvis": ShellPanel(TORSO_SHELL, (0.06, 0.26), (-180, 180)),
    "upper_arm": UPPER_ARM_SHELL,
    "shoulder_cap": ShellPanel(UPPER_ARM_SHELL, (0.06, 0.56), (40, 160)),
    "forearm": FOREARM_SHELL,
    "cuff": ShellPanel(FOREARM_SHELL, (0.42, 0.86), (-180, 180)),
    "hand": HAND_SHELL,
    "finger": FINGER_SHELL,
    "thigh": THIGH_SHELL,
    "thigh_side": ShellPanel(THIGH_SHELL, (0.28, 0.84), (25, 130)),
    "tibia": TIBIA_SHELL,
    "shin": ShellPanel(TIBIA_SHELL, (0.16, 0.80), (-48, 48)),
    "foot": FOOT_SHELL,
    "ring": Ring(210, 130),
    "toe": ShellPanel(FOOT_SHELL, (0.22, 0.62), (-62, 62)),
}


def write(folder: Path) -> None:
    """Write every shell into `folder` as `NAME.obj`, in [m]."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, shell in SHELLS.items():
        vertices, faces = shell.mesh()
        lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in vertices / 1000]
        lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
