"""Several robots of one project: each reads the files in its own way, and one robot is as it always was."""

from math import radians
from pathlib import Path

import pytest

import lumen
from lumen.language.house import RobotSpec, StartPose
from lumen.lint import check_files
from lumen.project.chosen_robot import as_robot
from lumen.project.files import fingerprint, read_files
from lumen.project.home import home_of, homes_of
from lumen.project.main_file import main_settings

HELLO = "id: hello\ninitial: here\nstates:\n  here: {entry: {play: nod}}\n"
OTHER = "id: other\ninitial: there\nstates:\n  there: {entry: {play: shake}}\n"
MAIN = """\
name: Two of Us
behavior: hello
languages: [en]
hall: hall.xml
robots:
  Ana: {model: nao, at: {x: 0.1, y: -0.4, facing: 90}}
  Ben: {model: v6, behavior: other, languages: [id, en], stand: hall-2}
routes:
  lamp: {key: "{stand}.{robot}.lamp", direction: out}
"""
NOD = "keyframes:\n  - {at: 1s, roles: {head.yaw: 0.5}}\n"


@pytest.fixture
def two(tmp_path: Path) -> Path:
    files = {"lumen.yaml": MAIN, "behaviors/hello.yaml": HELLO, "behaviors/other.yaml": OTHER}
    files |= {"motions/nod.yaml": NOD, "motions/shake.yaml": NOD}
    for file, text in files.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(text, "utf-8")
    return tmp_path


def test_each_robot_has_what_is_its_own_and_what_is_of_all(two: Path) -> None:
    (two / "lumen.yaml").write_text(MAIN.replace("{stand}", "museum"), "utf-8")
    ana, ben = lumen.load(two), lumen.load(two, robot="Ben")
    assert list(ana.robots) == ["Ana", "Ben"] == list(ben.robots)
    assert (ana.robot, ana.behavior, ana.languages, ana.body.name) == ("Ana", "hello", ("en",), "NAO")
    assert (ben.robot, ben.behavior, ben.languages, ben.body.name) == ("Ben", "other", ("id", "en"), "NAO V6")
    assert ana.robots["Ana"].at == StartPose(0.1, -0.4, radians(90))
    assert ana.robots["Ben"].at == StartPose(0.0, 0.3, 0.0)
    assert ana.house == "two-of-us"
    assert ana.hash == ben.hash
    assert ben.key_of("command") == "avatar.Ben.command"


def test_the_stand_is_that_of_each(two: Path) -> None:
    project, found = check_files(two, read_files(two))
    assert project is None
    assert [(d.code, d.place.line) for d in found] == [("route-key", 9)], "Ana has no stand"
    ben, found = check_files(two, as_robot(read_files(two), "Ben"))
    assert ben
    assert ben.routes["lamp"].key == "hall-2.{robot}.lamp"


def test_what_one_of_them_plays_is_used(two: Path) -> None:
    (two / "lumen.yaml").write_text(MAIN.replace("{stand}", "museum"), "utf-8")
    assert lumen.check(two) == []


def test_one_robot_has_no_folder_and_no_hash_of_its_own(tmp_path: Path) -> None:
    shipped = lumen.load()
    assert shipped.robots == {"NAO": RobotSpec("NAO", "nao", StartPose(), "tour", ("en", "id"), "visitor")}
    assert shipped.one_of_several == ""
    files = read_files(Path(shipped.root))
    assert ".robot" not in files
    assert fingerprint(as_robot(files, "NAO")) == shipped.hash
    assert home_of(tmp_path) == tmp_path / ".lumen"
    assert [home.folder for home in homes_of(tmp_path)] == [tmp_path / ".lumen"]


def test_each_of_several_has_a_home(two: Path) -> None:
    settings = main_settings(two, "Ben")
    assert settings
    assert settings.robot == "Ben"
    home_of(two, "Ben").mkdir(parents=True)
    assert home_of(two, "Ben") == two / ".lumen/robots/Ben"
    assert [home.folder for home in homes_of(two)] == [two / ".lumen", two / ".lumen/robots/Ben"]
