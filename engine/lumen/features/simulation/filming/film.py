"""A film of a run in simulated time, with event-driven shots and subtitles, drawn by one thread per core, at most 8."""

import os
from collections import deque
from collections.abc import Generator
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import accumulate
from math import atan2
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotModelError
from lumen.features.simulation.filming.options import FILM_SIZE
from lumen.features.simulation.filming.shots import (
    FIELD_OF_VIEW,
    CameraPlace,
    FilmMoment,
    HallPoint,
    Shot,
    ShotDirector,
    Subjects,
    camera_place,
    free_camera,
)
from lumen.features.simulation.lettering import ROBOT_COLOUR, VISITOR_COLOUR, subtitle, subtitle_pages, title
from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.rendering import FILM_QUALITY, PixelArray, RenderState, SceneRenderer, available
from lumen.features.simulation.robot import SimulatedRobot
from lumen.robot.command_table import speech_duration

FILM_RATE = 25
FilmSize = tuple[int, int]

TITLE_SHOWN, TITLE_FADES = 3.0, 0.6
"""The duration of the title, and of its fading in or out [s]."""

MAX_WAITING_FRAMES = 8
"""The maximum number of pictures that wait to be written; each needs as much memory as its pixels."""

FOLLOWING = 0.06
"""The share of the remaining distance that the camera moves towards its subject in each picture."""


class Picture(NamedTuple):
    """The data from which one picture is drawn."""

    state: RenderState
    camera: str | tuple[HallPoint, float, float, float]
    """The name of a camera of the model, or a free camera's target, azimuth [deg], elevation [deg] and distance [m]."""
    said: str
    """The text of the robot's subtitle; empty for no subtitle."""
    heard: str
    """The text of the visitor's subtitle; empty for no subtitle."""
    title: float
    """The title's opacity, from 0 to 1."""


class Film:
    """Writes an MP4 of a run: call `tick` whenever time has passed, and `close` at the end.

    `camera` is the name of a camera of the hall. If it is empty, the film uses its own camera, whose shots the calls of
    `happened` choose. `size` is (width, height) [px], both even. Raises RobotModelError if nothing can be drawn, if
    ffmpeg can't be started or if the hall has no such camera.
    """

    def __init__(
        self, path: Path, robot: SimulatedRobot, camera: str = "", *, size: FilmSize = FILM_SIZE, title: str = ""
    ) -> None:
        if reason := available():
            raise RobotModelError(reason)
        model = robot.world.model
        if camera and mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, camera) < 0:
            raise RobotModelError(f"the hall has no camera `{camera}` to film with")
        self._robot, self._camera, self._size, self._title = robot, camera, size, title
        roles = robot.body.roles
        self._renderer = SceneRenderer(model, FILM_QUALITY, robot.base.soles)
        links = roles.eyes.face or roles.torso, roles.torso
        self._head, self._torso = (model.body(f"{ROBOT_PREFIX}/{name}").id for name in links)
        self._director = ShotDirector()
        self._shown: tuple[Shot, HallPoint, HallPoint] | None = None
        self._drawers = [ThreadPoolExecutor(1, "lumen-film") for _ in range(min(os.cpu_count() or 1, 8))]
        self._waiting: deque[tuple[Future[PixelArray], int]] = deque()
        self._writer = _writer(path, size)
        self._said = self._heard = ""
        self._heard_until = 0.0
        self._said_from: float | None = None
        self._due = self._drawn = 0

    @property
    def frames(self) -> int:
        """The number of frames drawn or waiting so far."""
        return self._due

    @property
    def length(self) -> float:
        """The length of the film so far [s]."""
        return self._due / FILM_RATE

    def frame_due(self, now: float) -> bool:
        """Return True if the next frame is due at `now` [s]."""
        return now + 1e-9 >= self._due / FILM_RATE

    def happened(self, moment: FilmMoment) -> None:
        """Record an event of the run, which may change the shot."""
        self._director.happened(moment)

    def says(self, text: str) -> None:
        """Show a text as the robot's subtitle instead of the visitor's; an empty text removes the robot's subtitle."""
        self._said, self._said_from = text, None
        if text:
            self._heard = ""
            self.happened(FilmMoment.ROBOT_SPEAKS)

    def hears(self, text: str, now: float) -> None:
        """Show the visitor's words as a subtitle from `now` [s], for the time needed to read them."""
        self._heard, self._heard_until = text, now + 1.0 + 0.07 * len(text)
        self.happened(FilmMoment.VISITOR_SPEAKS)

    def tick(self, now: float) -> None:
        """Draw one picture for all frames due by `now` [s], if any; block the run if drawing can't keep up."""
        if not self.frame_due(now):
            return
        world = self._robot.world
        picture = Picture(
            RenderState.of(world.model, world.data),
            self._camera or self._directed(now),
            self._saying(now),
            self._heard if now < self._heard_until else "",
            _fading(now) if self._title else 0.0,
        )
        again = 0
        while self.frame_due(now):
            self._due += 1
            again += 1
        drawer = self._drawers[self._drawn % len(self._drawers)]
        self._drawn += 1
        self._waiting.append((drawer.submit(self._draw, picture), again))
        while len(self._waiting) > MAX_WAITING_FRAMES or (self._waiting and self._waiting[0][0].done()):
            self._write()

    def close(self) -> None:
        """Finish the file; further calls do nothing."""
        while self._waiting:
            self._write()
        self._writer.close()
        for drawer in self._drawers:
            drawer.submit(self._renderer.close)
            drawer.shutdown()
        self._drawers = []

    def _write(self) -> None:
        drawn, times = self._waiting.popleft()
        pixels = drawn.result().tobytes()
        for _ in range(times):
            self._writer.send(pixels)

    def _draw(self, picture: Picture) -> PixelArray:
        camera: str | mujoco.MjvCamera
        if isinstance(picture.camera, str):
            camera = picture.camera
        else:
            camera = mujoco.MjvCamera()
            camera.type = mujoco.mjtCamera.mjCAMERA_FREE
            camera.lookat[:], camera.azimuth, camera.elevation, camera.distance = picture.camera
        pixels = self._renderer.draw(picture.state, camera, *self._size, field_of_view=FIELD_OF_VIEW)
        if picture.said or picture.heard:
            text, colour = (picture.said, ROBOT_COLOUR) if picture.said else (picture.heard, VISITOR_COLOUR)
            subtitle(text, colour, *self._size).lay_on(pixels)
        elif picture.title > 0.0:
            title(self._title, *self._size).lay_on(pixels, picture.title)
        return pixels

    def _saying(self, now: float) -> str:
        """Return the robot's subtitle page for `now` [s], estimated from the usual speed of speech; empty for none."""
        if not self._said:
            return ""
        if self._said_from is None:
            self._said_from = now
        so_far = (now - self._said_from) / speech_duration(self._said) * len(self._said)
        pages = subtitle_pages(self._said, *self._size)
        ends = accumulate(len(page) + 1 for page in pages)
        return next((page for page, end in zip(pages, ends, strict=True) if so_far < end), pages[-1])

    def _directed(self, now: float) -> tuple[HallPoint, float, float, float]:
        """Return the target, azimuth [deg], elevation [deg] and distance [m] of the film's own camera."""
        who = self._subjects()
        shot = self._director.shot(now, who.visitor is not None)
        eye, target = camera_place(shot, who, self._size[0] / self._size[1])
        if self._shown and self._shown[0] is shot:
            eye, target = (_nearer(was, now_at) for was, now_at in zip(self._shown[1:], (eye, target), strict=True))
        self._shown = shot, eye, target
        return target, *free_camera(CameraPlace(eye, target))

    def _subjects(self) -> Subjects:
        data = self._robot.world.data
        head, torso = (_point(data.xpos[body]) for body in (self._head, self._torso))
        ahead = data.xmat[self._torso].reshape(3, 3)[:, 0]
        return Subjects(_up(head, 0.03), torso, atan2(ahead[1], ahead[0]), self._robot.figure.face())


def _nearer(was: HallPoint, wanted: HallPoint) -> HallPoint:
    x, y, z = (a + FOLLOWING * (b - a) for a, b in zip(was, wanted, strict=True))
    return x, y, z


def _point(place: NDArray[np.float64]) -> HallPoint:
    x, y, z = (float(part) for part in place)
    return x, y, z


def _up(point: HallPoint, by: float) -> HallPoint:
    return point[0], point[1], point[2] + by


def _fading(now: float) -> float:
    """Return the title's opacity at `now` [s], from 0 to 1."""
    return max(0.0, min(now / TITLE_FADES, (TITLE_SHOWN - now) / TITLE_FADES, 1.0))


def _writer(path: Path, size: FilmSize) -> Generator[None, bytes, None]:
    import imageio_ffmpeg

    writer: Generator[None, bytes, None] = imageio_ffmpeg.write_frames(
        str(path),
        size,
        fps=FILM_RATE,
        codec="libx264",
        quality=None,
        output_params=["-preset", "veryfast", "-crf", "20", "-movflags", "+faststart"],
        macro_block_size=2,
        ffmpeg_log_level="error",
    )
    try:
        writer.send(None)  # type: ignore[arg-type]  # starts the generator
    except (OSError, RuntimeError) as error:
        chosen = os.environ.get("IMAGEIO_FFMPEG_EXE", "")
        remedy = (
            f"IMAGEIO_FFMPEG_EXE={chosen} is not ffmpeg: unset it" if chosen else "install `lumen-robot[simulation]`"
        )
        raise RobotModelError(f"ffmpeg, which writes videos, cannot be started ({error}): {remedy}") from None
    return writer
