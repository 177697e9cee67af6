"""Files about robots and messages that a project lacks come with Lumen; other files do not."""

import shutil
from pathlib import Path

import pytest

import lumen
from lumen.lint import check_files
from lumen.project.lending import model_files
from tests import ROOT

SHIPPED = ROOT
MAIN = """\
name: Small
behavior: hello
languages: [en]
robot: {name: NAO, model: nao}
hall: hall.xml
routes:
  joint: {key: "avatar.{robot}.data.joint", direction: out, schema: joint, every: 60ms}
  heard: {key: lumen.audio.speech.recognition, direction: in, schema: speech.recognition, event: heard, ttl: 5s}
"""
HELLO = "id: hello\ninitial: here\nstates:\n  here:\n    on:\n      heard: {actions: {say: Hello}}\n"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors" / "hello.yaml").write_text(HELLO, "utf-8")
    (tmp_path / "lumen.yaml").write_text(MAIN, "utf-8")
    return tmp_path


def codes(root: Path) -> list[str]:
    return sorted(found.code for found in lumen.check(root))


def test_two_files_are_a_project(small: Path) -> None:
    project = lumen.load(small)
    assert project.body == lumen.load(SHIPPED).body
    assert set(project.messages) == {"joint", "speech.recognition"}
    assert model_files(project) == (SHIPPED / "models", "hall.xml")


def test_it_runs_with_physics_in_a_hall_of_its_own(small: Path) -> None:
    (small / "models").mkdir()
    shutil.copytree(SHIPPED / "models" / "hall", small / "models" / "hall")
    shutil.copy(SHIPPED / "models" / "hall.xml", small / "models")
    with lumen.open(small, robot="simulation", speed="max") as exhibition:
        exhibition.run(seconds=0.5)
        exhibition.send("heard", {"result": "hello"})
        exhibition.run(seconds=0.1)
    assert model_files(lumen.load(small)) == (SHIPPED / "models", str(small / "models" / "hall.xml"))


def test_its_own_files_count(small: Path) -> None:
    schemas = small / "schemas" / "messages"
    schemas.mkdir(parents=True)
    (schemas / "joint.schema.json").write_text("{", "utf-8")
    (small / "models").mkdir()
    (small / "models" / "nao.yaml").write_text("like: v6\nname: Ours\n", "utf-8")
    found = [(d.place.file, d.code) for d in lumen.check(small)]
    assert ("schemas/messages/joint.schema.json", "json-syntax") in found
    assert [code for file, code in found if file == "models/nao.yaml"] == ["unknown-model"]


def test_a_body_like_a_shipped_one(small: Path) -> None:
    (small / "models").mkdir()
    (small / "models" / "ours.yaml").write_text("like: nao\nname: Ours\n", "utf-8")
    (small / "lumen.yaml").write_text(MAIN.replace("model: nao", "model: ours"), "utf-8")
    body = lumen.load(small).body
    assert body.name == "Ours"
    assert body.joints == lumen.load(SHIPPED).body.joints


@pytest.mark.parametrize(
    ("there", "instead", "code"),
    [
        ("model: nao", "model: nap", "missing-folder"),
        ("schema: joint", "schema: joints", "unknown-message"),
        ("hall: hall.xml", "hall: hell.xml", "missing-file"),
        ("hall: hall.xml", "hall: ../models/hall.xml", "wrong-value"),
        ("schema: joint", "schema: ../body", "unknown-message"),
    ],
)
def test_what_comes_with_nobody_is_missed(small: Path, there: str, instead: str, code: str) -> None:
    (small / "lumen.yaml").write_text(MAIN.replace(there, instead), "utf-8")
    assert code in codes(small)


def test_it_depends_on_nothing_but_the_files_given(small: Path) -> None:
    files = {"lumen.yaml": MAIN.encode(), "behaviors/hello.yaml": HELLO.encode()}
    project, _ = check_files(small, files)
    assert project
    assert project.hash == lumen.load(small).hash


def test_a_body_that_comes_with_lumen_is_meant_where_its_name_is_nearly_written(small: Path) -> None:
    files = {"lumen.yaml": MAIN.replace("model: nao", "model: nau").encode(), "behaviors/hello.yaml": HELLO.encode()}
    (hint,) = (found.hint for found in check_files(small, files)[1] if found.code == "missing-folder")
    assert hint.startswith("did you mean `nao`, which comes with Lumen?")
