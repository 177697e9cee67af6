"""A film of a run, by simulated time."""

from collections.abc import Generator
from pathlib import Path

import mujoco

from lumen.errors import RobotModelError
from lumen.robots.simulation.rendering import FILM_QUALITY, RenderState, SceneRenderer, available
from lumen.robots.simulation.robot import SimulatedRobot

FILM_RATE = 25
FILM_WIDTH, FILM_HEIGHT = 640, 480


class Film:
    """Writes an MP4 of what a camera of the hall sees; `tick` whenever time has passed, `close` at the end.

    Raises RobotError where nothing can be drawn, saying which package to install, or the hall has no such camera.
    """

    def __init__(self, path: Path, robot: SimulatedRobot, camera: str = "observer") -> None:
        if reason := available():
            raise RobotModelError(reason)
        if mujoco.mj_name2id(robot.world.model, mujoco.mjtObj.mjOBJ_CAMERA, camera) < 0:
            raise RobotModelError(f"the hall has no camera `{camera}` to film with")
        self._robot, self._camera = robot, camera
        self._renderer = SceneRenderer(robot.world.model, FILM_QUALITY)
        self._writer = _writer(path)
        self.frames = 0

    @property
    def length(self) -> float:
        """How long it is by now [s]."""
        return self.frames / FILM_RATE

    def frame_due(self, now: float) -> bool:
        """Whether it is time [s] for the next frame."""
        return now + 1e-9 >= self.frames / FILM_RATE

    def tick(self, now: float) -> None:
        """Take the frames that are due by `now` [s]; the run waits for them."""
        if not self.frame_due(now):
            return
        world = self._robot.world
        pixels = self._renderer.draw(RenderState.of(world.model, world.data), self._camera, FILM_WIDTH, FILM_HEIGHT)
        while self.frame_due(now):
            self._writer.send(pixels.tobytes())
            self.frames += 1

    def close(self) -> None:
        """Finish the file; harmless when repeated."""
        self._writer.close()
        self._renderer.close()


def _writer(path: Path) -> Generator[None, bytes, None]:
    import imageio_ffmpeg

    writer: Generator[None, bytes, None] = imageio_ffmpeg.write_frames(
        str(path),
        (FILM_WIDTH, FILM_HEIGHT),
        fps=FILM_RATE,
        codec="libx264",
        quality=7,
        macro_block_size=2,
        ffmpeg_log_level="error",
    )
    writer.send(None)  # type: ignore[arg-type]  # starts the generator
    return writer
