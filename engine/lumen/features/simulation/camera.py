"""What the robot's camera sees."""

from lumen.features.simulation.rendering import CAMERA_QUALITY, PixelArray, RenderState, SceneRenderer, available
from lumen.features.simulation.world import World
from lumen.language.robots import Camera
from lumen.language.routes import Size
from lumen.motion.projection import project
from lumen.ports import Image


class RobotCamera:
    """Takes images, to be drawn later by another thread, and computes where a point appears in them."""

    def __init__(self, world: World, camera: Camera) -> None:
        self._world, self._camera = world, camera
        self._name = f"{world.prefix}/{world.body.roles.eyes.camera}"
        self._renderer = None if available() else SceneRenderer(world.model, CAMERA_QUALITY)

    def image(self, now: float) -> Image | None:
        """The image of this moment; None where nothing can be drawn."""
        if self._renderer is None:
            return None
        studio, camera, name = self._renderer, self._camera, self._name
        scene = RenderState.of(self._world.model, self._world.data)

        def pixels(size: Size | None = None) -> PixelArray:
            return studio.draw(scene, name, *(size or (camera.width, camera.height)))

        return Image(now, pixels)

    def pixel(self, point: tuple[float, float, float]) -> tuple[float, float] | None:
        """Where a point of the hall [m] appears [px]; None outside the image or behind."""
        view = self._world.data.camera(self._name)
        right, up, back = view.xmat.reshape(3, 3).T @ (point - view.xpos)
        return project((-float(back), -float(right), float(up)), self._camera)

    def close(self) -> None:
        """Let go of this thread's OpenGL context."""
        if self._renderer:
            self._renderer.close()
