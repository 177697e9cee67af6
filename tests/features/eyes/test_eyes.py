"""The visual module: drawn and photographed faces, names that it learns, and bodies that are not images."""

import base64
import importlib.util
import math
from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from lumen.clock.simulated import SimulatedClock
from lumen.errors import ModuleError
from lumen.features.eyes import gallery
from lumen.features.eyes.detector import Box, PersonDetector
from lumen.features.eyes.gallery import MAX_PICTURES_PER_NAME, FaceGallery
from lumen.features.eyes.module import Eyes
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.modules import module_names
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Sense
from lumen.run.exhibition import Exhibition
from lumen.run.making.modules import ModulesPlan
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import Setup
from tests.features.conftest import Stand, with_options

Make = Callable[..., Stand]
Pixels = NDArray[np.uint8]
IMAGE = "avatar.NAO.data.image"
PACKAGE = importlib.util.find_spec("skimage")
assert PACKAGE
assert PACKAGE.origin
PHOTOGRAPH = Path(PACKAGE.origin).parent / "data" / "astronaut.png"
"""Eileen Collins, photographed by NASA in 1993: public domain."""


def body(pixels: Pixels, time: float | None = None) -> dict[str, Any]:
    buffer = BytesIO()
    Image.fromarray(pixels).save(buffer, "JPEG", quality=80)
    url = "data:image/jpeg;base64," + base64.b64encode(buffer.getvalue()).decode()
    return {"name": "1", "contentType": "image/jpeg", "contentUrl": url} | ({} if time is None else {"time": time})


@pytest.fixture(scope="module")
def photographed() -> Pixels:
    """The photograph as 320 x 240 pixels, with the face at about (192, 61)."""
    with Image.open(PHOTOGRAPH) as picture:
        return np.asarray(picture.convert("RGB").crop((0, 0, 400, 300)).resize((320, 240)))


@pytest.fixture(scope="module")
def drawn(project: Project) -> Mapping[tuple[float, float], tuple[Pixels, tuple[float, float]]]:
    """Camera images of the visitor at four places [m], each with the true position of the face [px]."""
    robot = SimulatedRobot(project.body, Path(project.root) / "models", project.hall)
    seen = {}
    robot.advance(1.0)  # until it stands still
    for x, y in ((1.2, 0.3), (1.3, 0.5), (1.5, 0.0), (2.0, -0.5)):
        robot.place(Visitor(x=x, y=y))
        robot.advance(0.02)
        image, face = robot.read(Sense.IMAGE), robot.face()
        assert image
        assert face
        seen[x, y] = (image.pixels(), face)  # type: ignore[union-attr]
    robot.close()
    return seen


@pytest.fixture
def eyes(stand: Make) -> Callable[..., Stand]:
    def make(project: Project | None = None, file: Path | None = None) -> Stand:
        here = stand(project)
        here.add(Eyes(here.project, here.bus, here.told.append, file))
        return here

    return make


@pytest.mark.pictures
def test_finds_the_drawn_face_where_it_is(eyes: Make, project: Project, drawn: Mapping[Any, Any]) -> None:
    """The drawn head is larger than a person's."""
    here = eyes(with_options(project, "eyes", face_width=0.25))
    faces, exact = here.listen("lumen.visual.face.detection"), here.listen("lumen.visual.face.tracking")
    for number, (place, (pixels, truth)) in enumerate(drawn.items()):
        here.bus.publish(IMAGE, body(pixels, float(number)))
        here.settle()
        seen, face = exact.bodies[-1], dict(faces.bodies[-1])
        assert math.dist((seen["x"], seen["y"]), truth) < 5.0
        assert face.pop("distance") == pytest.approx(math.hypot(*place), rel=0.35)
        assert face == {"x": round(seen["x"]), "y": round(seen["y"]), "time": float(number)}


@pytest.mark.slow
def test_finds_a_photographed_face_at_any_size(eyes: Make, photographed: Pixels) -> None:
    here = eyes()
    faces = here.listen("lumen.visual.face.detection")
    for number, size in enumerate(((320, 240), (640, 480))):
        large = np.asarray(Image.fromarray(photographed).resize(size))
        here.bus.publish(IMAGE, body(large, float(number)))
        here.settle()
    assert len(faces.bodies) == 2
    for face in faces.bodies:
        assert math.dist((face["x"], face["y"]), (179, 96)) < 8.0


@pytest.mark.slow
def test_finds_nobody_where_nobody_is(eyes: Make) -> None:
    here = eyes()
    seen = here.listen("lumen.visual.#")
    rng = np.random.default_rng(1)
    for number in range(2):
        here.bus.publish(IMAGE, body(rng.integers(0, 255, (240, 320, 3), dtype=np.uint8), float(number)))
        here.settle()
    assert seen.bodies == []


@pytest.mark.pictures
def test_sees_that_there_are_people(eyes: Make, drawn: Mapping[Any, Any]) -> None:
    pixels, (x, _) = drawn[1.2, 0.3]
    here = eyes()
    people = here.listen("lumen.visual.human.detection")
    here.bus.publish(IMAGE, body(pixels, 1.0))
    here.settle()
    assert abs(people.wait(1)[0]["x"] - x) < 40


@pytest.mark.slow
def test_who_shows_their_face_is_a_person(photographed: Pixels) -> None:
    grey, finder = cv2.cvtColor(photographed, cv2.COLOR_RGB2GRAY), PersonDetector()
    assert finder.people(grey) == [], "from the chest up there is no whole person"
    [face] = finder.faces(grey)
    [person] = finder.people(grey, [face])
    assert person.holds(face.centre)
    assert person.x >= 0.0
    assert person.y + person.height == 240.0, "down to the rim of the picture"
    assert finder.people(grey, []) == []


@pytest.mark.pictures
def test_learns_who_somebody_is_and_tells_them_from_others(
    eyes: Make, tmp_path: Path, photographed: Pixels, drawn: Mapping[Any, Any]
) -> None:
    here, file = eyes(None, tmp_path / "faces.npz"), tmp_path / "faces.npz"
    who = here.listen("lumen.visual.face.recognition")

    def look(at: float, pixels: Pixels) -> str:
        here.bus.publish(IMAGE, body(pixels, at))
        here.settle()
        return str(who.bodies[-1]["name"])

    assert look(0.0, photographed) == "unknown"
    here.bus.publish("lumen.visual.command", "Eileen")
    for number in range(8):
        look(1.0 + number / 5, np.roll(photographed, number, axis=1))
    assert here.told == ["has learnt the face of Eileen"]
    assert look(10.0, np.roll(photographed, 9, axis=1)) == "Eileen"
    assert look(20.0, drawn[1.5, 0.0][0]) == "unknown"
    assert FaceGallery(file, lambda: 0.0).names == ["Eileen"]
    assert file.stat().st_mode & 0o077 == 0
    here.bus.publish("lumen.NAO.persistence.forgotten", {"name": "eileen"})
    assert look(30.0, photographed) == "unknown"
    assert FaceGallery(file, lambda: 0.0).names == []


@pytest.mark.slow
def test_faces_that_were_learnt_long_ago_are_deleted(photographed: Pixels) -> None:
    grey = cv2.cvtColor(photographed, cv2.COLOR_RGB2GRAY)
    (face, *_) = PersonDetector().faces(grey)
    known = FaceGallery(None, lambda: 100.0)
    known.enrol("Eileen", grey, face)
    assert known.who(grey, face) == "Eileen"
    assert known.expire(100.0) == 0
    assert known.expire(100.1) == 1
    assert known.who(grey, face) == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"contentUrl": "data:image/jpeg;base64,QUJD"}, "it cannot be read (UnidentifiedImageError)"),
        ({"contentUrl": "data:image/jpeg;base64,@@@"}, "its `contentUrl` is not base64"),
        ({"contentUrl": "data:image/jpeg;base64,bm8gcGljdHVyZQ=="}, "it cannot be read (UnidentifiedImageError)"),
        (body(np.zeros((8, 8, 3), np.uint8)), "is 8 x 8 px: its width and height must be between 32 and 4096"),
        (body(np.zeros((10, 5000, 3), np.uint8)), "is 5000 x 10 px"),
    ],
)
def test_an_image_that_is_none_is_one_line(eyes: Make, photographed: Pixels, wrong: dict[str, Any], said: str) -> None:
    here = eyes()
    faces = here.listen("lumen.visual.face.detection")
    for number in range(3):
        here.bus.publish(IMAGE, {"name": "1", "contentType": "image/jpeg", **wrong, "time": float(number)})
        here.settle()
    assert len(here.told) == 1
    assert said in here.told[0]
    here.bus.publish(IMAGE, body(photographed, 5.0))
    here.settle()
    assert len(faces.bodies) == 1


@pytest.mark.parametrize("name", ["", "x" * 61, "a\nb", {"name": "Ani"}, 7])
def test_a_name_that_is_none(eyes: Make, name: object) -> None:
    here = eyes()
    here.bus.publish("lumen.visual.command", name)
    here.settle()
    assert "needs a `name` of at most 60 characters" in here.told[0]


def test_a_model_that_does_not_load(tmp_path: Path) -> None:
    with pytest.raises(ModuleError, match=r"nowhere.xml is missing: pip install 'lumen-robot\[eyes\]'"):
        PersonDetector(tmp_path / "nowhere.xml")
    (tmp_path / "broken.xml").write_text("<opencv_storage><cascade>")
    with pytest.raises(ModuleError, match=r"broken.xml cannot be loaded"):
        PersonDetector(tmp_path / "broken.xml")


def test_faces_that_are_damaged(tmp_path: Path) -> None:
    (tmp_path / "faces.npz").write_bytes(b"no faces")
    with pytest.raises(ModuleError, match="contains no faces or is damaged"):
        FaceGallery(tmp_path / "faces.npz", lambda: 0.0)


def test_a_face_that_is_deleted_while_the_file_cannot_be_written_is_deleted_from_it_later(tmp_path: Path) -> None:
    file, grey, face = tmp_path / "faces.npz", np.tile(np.arange(96, dtype=np.uint8), (96, 1)), Box(0, 0, 96, 96)
    known = FaceGallery(file, lambda: 0.0)
    known.enrol("Eileen", grey, face)
    file.rename(tmp_path / "aside")
    file.mkdir()
    with pytest.raises(ModuleError, match="cannot be written"):
        known.forget("Eileen")
    assert known.names == []
    file.rmdir()
    (tmp_path / "aside").rename(file)
    assert FaceGallery(file, lambda: 0.0).names == ["Eileen"]
    assert known.forget("Eileen") == 0
    assert FaceGallery(file, lambda: 0.0).names == []


def test_a_picture_that_replaces_the_oldest_needs_no_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gallery, "MAX_PICTURES", MAX_PICTURES_PER_NAME)
    grey, face = np.tile(np.arange(96, dtype=np.uint8), (96, 1)), Box(0, 0, 96, 96)
    known = FaceGallery(None, lambda: 0.0)
    counts = [known.enrol("Eileen", grey, face) for _ in range(MAX_PICTURES_PER_NAME + 1)]
    assert counts == [*range(1, MAX_PICTURES_PER_NAME + 1), MAX_PICTURES_PER_NAME]
    with pytest.raises(ModuleError, match="the gallery is full"):
        known.enrol("Dewi", grey, face)
    assert known.forget("Eileen") == MAX_PICTURES_PER_NAME


@pytest.mark.slow
def test_a_video_file(stand: Make, project: Project, photographed: Pixels, tmp_path: Path) -> None:
    writer = cv2.VideoWriter(str(tmp_path / "v.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (320, 240))
    for _ in range(6):
        writer.write(cv2.cvtColor(photographed, cv2.COLOR_RGB2BGR))
    writer.release()
    here = stand(with_options(project, "eyes", camera=str(tmp_path / "v.avi"), every=0.001))
    faces = here.listen("lumen.visual.face.detection")
    here.add(Eyes(here.project, here.bus, here.told.append, None))
    assert all("time" not in face for face in faces.wait(6))
    here.settle()
    with pytest.raises(ModuleError, match="there is no video"):
        Eyes(with_options(project, "eyes", camera="gone.avi"), here.bus, here.told.append, None)
    (tmp_path / "none.avi").write_text("no video")
    with pytest.raises(ModuleError, match="cannot be opened: its video format is not supported"):
        Eyes(with_options(project, "eyes", camera=str(tmp_path / "none.avi")), here.bus, here.told.append, None)


@pytest.mark.pictures
def test_the_head_turns_to_a_face_that_was_seen_in_the_image(project: Project) -> None:
    """Rendered camera, JPEG, bus, detector, fuzzy controller, head: the whole way through pixels."""
    robot = SimulatedRobot(project.body, Path(project.root) / "models", project.hall)
    lines = RehearsalTrace(lambda: show.now, lambda: show.project.machine, None)
    setup = Setup(robot, SimulatedClock(robot.advance, None), robot)
    options = {"operated": False, "modules": ModulesPlan(awaited=True)}
    show = Exhibition(Plan(with_options(project, "eyes"), setup, narrator=lines, options=options))
    seen = []
    show.services.bus.subscribe("lumen.visual.face.#", lambda message: seen.append((message.key, message.body)))
    try:
        show.start()
        assert show.visitor
        show.visitor.arrive(Visitor(x=1.3, y=0.6))
        distances = []
        while show.tick() < 5.0:
            face = robot.face()
            distances.append(math.dist(face, (160, 120)) if face else math.inf)
    finally:
        show.close()
    faces = [b for key, b in seen if key.endswith("detection")]
    assert not [who for _, who, _ in lines.lines if who in module_names()]
    assert len(faces) == sum(key.endswith("tracking") for key, _ in seen) > 10
    assert max(distances[:50]) > 60.0
    assert max(distances[-25:]) < 12.0
