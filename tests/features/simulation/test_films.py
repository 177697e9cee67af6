"""A film: what its camera shows, the texts in it, and its reported progress."""

from itertools import pairwise
from math import atan2, cos, degrees, dist, hypot, pi, radians, sin, tan
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.features.simulation.filming.film import Film
from lumen.features.simulation.filming.progress import FilmProgress
from lumen.features.simulation.filming.shots import (
    FIELD_OF_VIEW,
    LONGEST_SHOT,
    SHORTEST_SHOT,
    CameraPlace,
    FilmMoment,
    HallPoint,
    Shot,
    ShotDirector,
    Subjects,
    camera_place,
    free_camera,
)
from lumen.features.simulation.lettering import MAX_LINES, ROBOT_COLOUR, subtitle, subtitle_pages
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.stories import Visitor
from tests.tables import for_each

HEAD: HallPoint = (0.0, 0.0, 1.0)
TORSO: HallPoint = (0.0, 0.0, 0.83)
ALONE = Subjects(HEAD, TORSO, 0.0, None)


def shown(moments: dict[float, FilmMoment], until: float, visitor: bool = True) -> list[tuple[float, Shot]]:
    """Return the cuts of a film, looked at 25 times a second."""
    director, cuts = ShotDirector(), list[tuple[float, Shot]]()
    for frame in range(round(until * 25)):
        now = frame / 25
        for at, moment in moments.items():
            if frame == round(at * 25):
                director.happened(moment)
        shot = director.shot(now, visitor)
        if not cuts or cuts[-1][1] is not shot:
            cuts.append((now, shot))
    return cuts


def test_who_speaks_is_seen_and_who_moves_is_seen_whole() -> None:
    moments = {3.0: FilmMoment.ROBOT_SPEAKS, 6.0: FilmMoment.VISITOR_SPEAKS, 9.0: FilmMoment.ROBOT_MOVES}
    assert shown(moments, 11.0) == [
        (0.0, Shot.FULL_SHOT),
        (3.0, Shot.CLOSE_UP),
        (6.0, Shot.POINT_OF_VIEW),
        (9.0, Shot.FULL_SHOT),
    ]


@given(times=st.dictionaries(st.floats(0, 60), st.sampled_from(list(FilmMoment)), max_size=40), visitor=st.booleans())
def test_nothing_is_cut_faster_than_an_eye_follows(times: dict[float, FilmMoment], visitor: bool) -> None:
    cuts = shown(times, 60.0, visitor)
    gaps = [b[0] - a[0] for a, b in pairwise(cuts)]
    assert all(gap >= SHORTEST_SHOT - 1e-6 for gap in gaps)
    if visitor:
        assert all(gap <= LONGEST_SHOT + 0.05 for gap in gaps)
    else:
        assert {shot for _, shot in cuts} <= {Shot.FULL_SHOT, Shot.CLOSE_UP}


def in_picture(place: CameraPlace, point: HallPoint, aspect: float) -> tuple[float, float]:
    """Project a point into a picture: (0, 0) is the middle, 1 the edge, right and up are positive."""
    azimuth, elevation, _ = free_camera(place)
    a, e = radians(azimuth), radians(elevation)
    ahead = np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
    right = np.array([sin(a), -cos(a), 0.0])
    up = np.cross(right, ahead)
    way = np.array(point) - np.array(place.eye)
    depth = float(way @ ahead)
    assert depth > 0.05, "what is behind the camera is not in its picture"
    half = tan(radians(FIELD_OF_VIEW) / 2)
    return float(way @ right) / depth / half / aspect, float(way @ up) / depth / half


@given(
    distance=st.floats(0.6, 2.5),
    bearing=st.floats(-1.0, 1.0),
    height=st.floats(1.0, 1.9),
    heading=st.floats(-0.6, 0.6),
    shot=st.sampled_from([Shot.TWO_SHOT, Shot.CLOSE_UP, Shot.POINT_OF_VIEW]),
    aspect=st.sampled_from([16 / 9, 4 / 3, 9 / 16]),
)
def test_whom_a_shot_is_about_is_in_its_picture(
    distance: float, bearing: float, height: float, heading: float, shot: Shot, aspect: float
) -> None:
    visitor = (distance * cos(bearing), distance * sin(bearing), height)
    who = Subjects(HEAD, TORSO, heading, visitor)
    place = camera_place(shot, who, aspect)
    seen = [HEAD, visitor] if shot is Shot.TWO_SHOT else [HEAD]
    for point in seen:
        assert max(map(abs, in_picture(place, point, aspect))) < 0.97
    if shot is Shot.CLOSE_UP and distance > 0.9:
        beside = hypot(place.eye[0] - visitor[0], place.eye[1] - visitor[1])
        assert beside > 0.25, "the camera stands in nobody"


@for_each("shot", [Shot.CLOSE_UP, Shot.FULL_SHOT])
@for_each("heading", [-2.0, 0.0, 0.6, 3.0])
@for_each(("bearing", "side"), [(-1.0, 32.0), (0.0, -32.0), (1.0, -32.0)])
def test_the_robot_is_seen_from_in_front_and_beside_the_visitor(
    shot: Shot, heading: float, bearing: float, side: float
) -> None:
    visitor = (cos(heading + bearing), sin(heading + bearing), 1.6)
    x, y, _ = camera_place(shot, Subjects(HEAD, TORSO, heading, visitor), 16 / 9).eye
    assert degrees(atan2(y, x) - heading + pi) % 360 - 180 == pytest.approx(side)


def test_an_eye_looks_at_its_target() -> None:
    place = CameraPlace((1.0, -2.0, 1.3), (0.0, 0.0, 0.8))
    azimuth, elevation, distance = free_camera(place)
    assert azimuth == pytest.approx(degrees(atan2(2, -1)))
    assert elevation < 0
    assert distance == pytest.approx(dist(*place))


@pytest.mark.pictures
def test_a_film_shows_what_is_said_and_who_says_it(robot: SimulatedRobot, tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    film = Film(path, robot, size=(320, 180))
    robot.place(Visitor())
    film.says("Hello, Ayu! Good morning to you.")
    for _ in range(3):
        robot.advance(0.04)
        film.tick(robot.time)
    film.says("")
    for _ in range(3):
        robot.advance(0.04)
        film.tick(robot.time)
    film.close()
    frames = imageio_ffmpeg.read_frames(str(path))
    width, height = next(frames)["size"]
    pictures = [np.frombuffer(frame, np.uint8).reshape(height, width, 3).astype(int) for frame in frames]
    assert (width, height) == (320, 180)
    box = subtitle("Hello, Ayu! Good morning to you.", ROBOT_COLOUR, 320, 180)
    tall, wide = box.pixels.shape[:2]
    change = abs(pictures[1] - pictures[-1])
    assert change[box.top : box.top + tall, box.left : box.left + wide].mean() > 8, "letters come, and go with the text"
    assert change[: box.top].mean() < 4, "nothing else does"


def test_letters_stay_in_the_picture() -> None:
    text = "Ein sehr langer Satz, den niemand in einem Atemzug sagt, mit Ärger und „Gänsefüßchen“. " * 3
    for size in ((1920, 1080), (320, 240), (240, 426)):
        lines = subtitle(text, ROBOT_COLOUR, *size)
        height, width = lines.pixels.shape[:2]
        assert lines.left >= 0
        assert lines.top >= 0
        assert lines.left + width <= size[0]
        assert lines.top + height <= size[1]
    assert (subtitle("Łódź 你好 \x00\n", ROBOT_COLOUR, 640, 480).pixels[:, :, 3] > 0).any()


def test_how_far_a_film_is_is_said_now_and_then() -> None:
    said, now = list[str](), [0.0]
    progress = FilmProgress(said.append, 100.0, lambda: now[0])
    for second in range(61):
        now[0] = float(second)
        progress.tick(second / 3)
    assert said == [
        "video: 5 of about 100 s are ready; about 4:45 min to go",
        "video: 10 of about 100 s are ready; about 4:30 min to go",
        "video: 15 of about 100 s are ready; about 4:15 min to go",
        "video: 20 of about 100 s are ready; about 4:00 min to go",
    ]


def test_long_texts_follow_each_other_in_few_lines() -> None:
    text = (
        "This is Electrical Engineering Days. Here the School of Electrical Engineering and Informatics of Bandung"
        " Institute of Technology shows what its students and researchers build, and they like to be asked about it."
    )
    pages = subtitle_pages(text, 1920, 1080)
    assert " ".join(pages) == text
    assert len(pages) == 2
    line = subtitle("Hello", ROBOT_COLOUR, 1920, 1080).pixels.shape[0]
    assert all(subtitle(page, ROBOT_COLOUR, 1920, 1080).pixels.shape[0] < (MAX_LINES + 1) * line for page in pages)
    assert subtitle_pages("Hello, Ayu!", 320, 180) == ("Hello, Ayu!",)
    assert subtitle_pages("Donaudampfschifffahrt" * 9, 320, 180) == ("Donaudampfschifffahrt" * 9,)
