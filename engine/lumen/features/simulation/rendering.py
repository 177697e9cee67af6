"""Pictures of the simulated world, which any thread can draw."""

import atexit
import copy
import threading
from dataclasses import dataclass
from math import hypot, radians, tan

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation import gl
from lumen.features.simulation.contact_shadows import NO_SOLES, ContactShadows, Soles
from lumen.features.simulation.physics import mujoco

HIDDEN = mujoco.mjNGROUP - 1
"""The geom group that is not drawn."""


class FrustumCulling:
    """Hides a model's geoms that are entirely outside the cone around a camera's picture; planes are never hidden.

    Hiding changes the geoms' groups, but not a picture without shadows. It saves time, because most of a robot's geoms
    are behind its camera.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._groups = model, model.geom_group.copy()
        self._planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE

    def cull(self, data: mujoco.MjData, camera: str, aspect: float) -> None:
        """Hide the geoms that this camera can't see, and show the rest; `aspect` is the picture's width / height."""
        model, eye = self._model, data.camera(camera)
        slope = tan(radians(model.camera(camera).fovy[0]) / 2) * hypot(1.0, aspect)
        away = data.geom_xpos - eye.xpos
        ahead = -(away @ eye.xmat[2::3])
        aside = np.sqrt(np.maximum((away * away).sum(axis=1) - ahead * ahead, 0.0))
        seen = aside - slope * ahead <= hypot(1.0, slope) * model.geom_rbound
        model.geom_group[:] = np.where(seen | self._planes, self._groups, HIDDEN)


PixelArray = NDArray[np.uint8]
"""An RGB image, Shape (height, width, 3)."""


def available() -> str | None:
    """Return the reason why nothing can be drawn, with the package to install; None if drawing works."""
    return gl.missing()


@dataclass(frozen=True, slots=True)
class RenderQuality:
    """The settings that determine a picture's quality and cost."""

    shadows: int = 0
    """The width of the shadow map [px]; 0 for no shadows."""
    samples: int = 0
    """The number of antialiasing samples per pixel; 0 for no antialiasing."""
    contact: bool = False
    """True to draw dark spots under the feet."""
    sides: tuple[int, int] | None = None
    """The numbers of faces of round shapes, around and from top to bottom; None for the model's numbers."""


CAMERA_QUALITY = RenderQuality(sides=(20, 12))
FILM_QUALITY = RenderQuality(shadows=2048, samples=4, contact=True)


@dataclass(frozen=True, slots=True)
class RenderState:
    """A copy of the state on which a picture depends, for drawing it later."""

    positions: NDArray[np.float64]
    """The positions of all joints, MuJoCo's `qpos` [m, rad]."""
    visitor_place: NDArray[np.float64]
    """The position of the visitor's body [m]."""
    visitor_turn: NDArray[np.float64]
    """The rotation of the visitor's body, a quaternion."""
    colours: NDArray[np.float32]
    """The materials' colours: red, green, blue and opacity from 0 to 1."""
    sizes: NDArray[np.float64]
    """The geoms' sizes [m]."""
    places: NDArray[np.float64]
    """The geoms' positions in their bodies [m]."""
    bounds: NDArray[np.float64]
    """The radii of the geoms' bounding spheres [m]."""

    @classmethod
    def of(cls, model: mujoco.MjModel, data: mujoco.MjData) -> "RenderState":
        """Return a copy of the present scene, about 9 kB."""
        return cls(
            data.qpos.copy(),
            data.mocap_pos.copy(),
            data.mocap_quat.copy(),
            model.mat_rgba.copy(),
            model.geom_size.copy(),
            model.geom_pos.copy(),
            model.geom_rbound.copy(),
        )


class SceneRenderer:
    """Draws scenes of one model, on any thread.

    Each thread gets its own OpenGL context for each picture size, created at its first picture of that size.
    """

    def __init__(self, model: mujoco.MjModel, quality: RenderQuality, soles: Soles = NO_SOLES) -> None:
        self._model, self._quality, self._soles = model, quality, soles
        self._local = threading.local()

    def draw(
        self,
        scene: RenderState,
        camera: str | mujoco.MjvCamera,
        width: int,
        height: int,
        *,
        field_of_view: float | None = None,
    ) -> PixelArray:
        """Return the picture of a scene through a named camera of the model or a free camera.

        `width` and `height` are the picture's size [px]. `field_of_view` is a free camera's vertical angle [deg]; None
        keeps the last one.
        """
        cameras: dict[tuple[int, int], _Canvas] = self._local.__dict__.setdefault("canvases", {})
        canvas = cameras.get((width, height))
        if canvas is None:
            canvas = cameras[width, height] = _Canvas(self._model, self._quality, self._soles, width, height)
        return canvas.draw(scene, camera, field_of_view)

    def close(self) -> None:
        """Close the calling thread's contexts; other threads' contexts stay open until the program ends."""
        for canvas in self._local.__dict__.pop("canvases", {}).values():
            canvas.close()


class _Canvas:
    """A renderer with its own model and state, for one thread and one picture size."""

    def __init__(self, model: mujoco.MjModel, quality: RenderQuality, soles: Soles, width: int, height: int) -> None:
        self._model = copy.copy(model)
        self._model.vis.quality.shadowsize = quality.shadows
        self._model.vis.quality.offsamples = quality.samples
        if quality.sides:
            self._model.vis.quality.numslices, self._model.vis.quality.numstacks = quality.sides
        self._model.vis.global_.offwidth = max(width, self._model.vis.global_.offwidth)
        self._model.vis.global_.offheight = max(height, self._model.vis.global_.offheight)
        self._data = mujoco.MjData(self._model)
        self._renderer = mujoco.Renderer(self._model, height, width, max_geom=2000)
        atexit.register(self.close)  # registered after mujoco's handler, so it runs before mujoco ends OpenGL
        self._renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = bool(quality.shadows)
        self._contact = ContactShadows(self._model, soles) if quality.contact else None
        self._culling, self._aspect = None if quality.shadows else FrustumCulling(self._model), width / height

    def draw(
        self, scene: RenderState, camera: str | mujoco.MjvCamera, field_of_view: float | None = None
    ) -> PixelArray:
        """Return the image of `scene` through `camera`; `field_of_view` is a free camera's vertical angle [deg]."""
        model, data = self._model, self._data
        if field_of_view is not None:
            model.vis.global_.fovy = field_of_view
        data.qpos[:] = scene.positions
        data.mocap_pos[:], data.mocap_quat[:] = scene.visitor_place, scene.visitor_turn
        model.mat_rgba[:] = scene.colours
        model.geom_size[:], model.geom_pos[:], model.geom_rbound[:] = scene.sizes, scene.places, scene.bounds
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        if self._culling and isinstance(camera, str):
            self._culling.cull(data, camera, self._aspect)
        self._renderer.update_scene(data, camera)
        if self._contact:
            self._contact.add(self._renderer.scene, data)
        pixels: PixelArray = self._renderer.render()
        return pixels

    def close(self) -> None:
        """Close the renderer."""
        atexit.unregister(self.close)
        self._renderer.close()
