"""Camera images, films and shells. These tests need an OpenGL library, which the tests' packages contain."""

import os
import sys
import threading
from pathlib import Path

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from lumen.errors import RobotError
from lumen.features.simulation.filming.film import FILM_RATE, Film
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.rendering import FrustumCulling
from lumen.features.simulation.shells import write
from lumen.language.commands import Look
from lumen.language.robots import Body
from lumen.language.routes import Size
from lumen.language.stories import Visitor
from lumen.ports import Image, Sense
from tests.features.simulation.conftest import MODELS, Do, look_at_face
from tests.guarded import run_guarded
from tests.waiting import HANG

Pixels = NDArray[np.uint8]


def image(robot: SimulatedRobot) -> Image:
    reading = robot.read(Sense.IMAGE)
    assert isinstance(reading, Image)
    return reading


@pytest.mark.pictures
def test_the_camera_sees_the_visitor_s_face_where_it_is_said_to_be(robot: SimulatedRobot, do: Do, body: Body) -> None:
    robot.place(Visitor())
    look_at_face(robot, do, body)
    seen = image(robot)
    robot.place(None)
    empty = image(robot)
    with_visitor, without = seen.pixels().astype(int), empty.pixels().astype(int)
    assert with_visitor.shape == (240, 320, 3)
    changed = np.abs(with_visitor - without).sum(axis=2) > 40
    assert changed[108:134, 150:170].mean() > 0.9
    assert not changed[:, :60].any()


@pytest.mark.pictures
def test_an_image_is_as_large_as_is_asked_for_and_shows_the_same(robot: SimulatedRobot) -> None:
    robot.place(Visitor())
    robot.advance(0.1)
    reading = image(robot)
    small, large = reading.pixels().astype(int), reading.pixels(Size(640, 480)).astype(int)
    assert large.shape == (480, 640, 3)
    shrunk = large.reshape(240, 2, 320, 2, 3).mean(axis=(1, 3))
    assert np.abs(shrunk - small).mean() < 4


@pytest.mark.pictures
@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (-0.4, 0.5), (1.5, -0.6)])
def test_what_a_camera_can_t_see_is_not_drawn_and_nobody_sees_that(
    robot: SimulatedRobot, do: Do, yaw: float, pitch: float
) -> None:
    robot.place(Visitor())
    assert do(Look(yaw, pitch)) == "done"
    model, data = robot.world.model, robot.world.data
    renderer = mujoco.Renderer(model, 240, 320)
    renderer.update_scene(data, "nao/CameraTop")
    whole, geoms = renderer.render().copy(), renderer.scene.ngeom
    FrustumCulling(model).cull(data, "nao/CameraTop", 4 / 3)
    renderer.update_scene(data, "nao/CameraTop")
    assert renderer.scene.ngeom < geoms / 2
    assert (renderer.render() == whole).all()
    renderer.close()


@pytest.mark.pictures
def test_another_thread_draws_the_moment_of_the_reading(robot: SimulatedRobot) -> None:
    robot.place(Visitor())
    robot.advance(0.1)
    reading = image(robot)
    before = reading.pixels().copy()
    robot.place(None)
    robot.advance(1.0)
    drawn: list[Pixels] = []
    thread = threading.Thread(target=lambda: drawn.append(reading.pixels()))
    thread.start()
    thread.join(HANG)
    assert (drawn[0] == before).all()


@pytest.mark.pictures
def test_a_film_has_a_frame_for_every_twenty_fifth_of_a_second(robot: SimulatedRobot, tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    film = Film(path, robot, "observer", size=(320, 240))
    for _ in range(20):
        robot.advance(0.02)
        film.tick(robot.time)
    film.close()
    film.close()
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == film.frames == 11
    assert seconds * FILM_RATE == frames


@pytest.mark.pictures
def test_a_hall_without_that_camera_is_not_filmed(robot: SimulatedRobot, tmp_path: Path) -> None:
    with pytest.raises(RobotError, match="the hall has no camera `ceiling`"):
        Film(tmp_path / "film.mp4", robot, "ceiling")


@pytest.mark.slow
def test_without_opengl_there_are_no_images_and_a_remedy() -> None:
    script = f"""
import pathlib
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.yaml_reader import parse
from lumen.ports import Sense
from lumen.features.simulation.offers import SimulatedRobot, available
models = pathlib.Path({str(MODELS)!r})
document, _ = parse("models/nao.yaml", (models / "nao.yaml").read_bytes())
robot = SimulatedRobot(build_body(document.data, DocumentReport(document), name="nao"), models, "hall.xml")
robot.advance(0.1)
print(robot.read(Sense.IMAGE), available())
"""
    environment = {**os.environ, "MUJOCO_GL": "disable"}
    run = run_guarded([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert run.stdout.startswith("None there is no OpenGL library")
    assert "libegl1 and libgl1" in run.stdout
    assert not run.stderr


def test_the_shells_are_what_the_script_makes(tmp_path: Path) -> None:
    write(tmp_path)
    made = {path.name: path.read_text().split("\n") for path in tmp_path.iterdir()}
    shipped = {path.name: path.read_text().split("\n") for path in (MODELS / "nao").iterdir()}
    assert made.keys() == shipped.keys()
    for name, lines in made.items():
        assert [line[0:1] for line in lines] == [line[0:1] for line in shipped[name]]
        assert np.abs(numbers(lines) - numbers(shipped[name])).max() < 2e-5, name


def numbers(lines: list[str]) -> NDArray[np.float64]:
    return np.array([float(word) for line in lines for word in line.split()[1:]])
