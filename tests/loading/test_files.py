"""Reading a project: every file once, and nothing that a file system can do raises."""

import os
import shutil
from pathlib import Path

import pytest

import lumen
from lumen.errors import ProjectError, UsageError
from lumen.loading.files import Unreadable, fingerprint, read_files
from lumen.loading.packaged import find_project, shipped_root
from lumen.loading.yaml_reader import parse
from lumen.rules import check_files

BASE = Path(__file__).parents[1] / "lint" / "base"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    shutil.copytree(BASE, tmp_path / "project")
    return tmp_path / "project"


def codes(root: Path) -> list[str]:
    return [d.code for d in lumen.check(root)]


def test_a_project_is_loaded_with_all_its_parts(project: Path) -> None:
    loaded = lumen.load(project)
    assert (loaded.name, loaded.robot, loaded.behavior, loaded.story) == ("Small", "TINY", "tour", "hello")
    assert loaded.languages == ("en", "id")
    assert loaded.routes["note"].key_for(loaded.robot) == "avatar.TINY.note"
    assert loaded.routes["note"].ttl == 5.0
    assert loaded.routes["face"].latency == 0.15
    assert loaded.stage is not None
    assert loaded.stage.y == (-0.6, 0.6)
    assert loaded.machine is loaded.behaviors["tour"]
    assert set(loaded.motions) == {"wave"}
    assert set(loaded.controllers) == {"head"}
    assert set(loaded.messages) == {"face", "heard"}
    assert loaded.stories["hello"].clock == "09:30"
    assert len(loaded.stories["hello"].steps) == 8
    assert loaded.body.name == "tiny"


def test_the_same_files_make_the_same_project(project: Path) -> None:
    files = read_files(project)
    assert check_files(project, files)[0] == check_files(project, dict(reversed(files.items())))[0]


def test_the_hash_tells_contents_and_names_apart() -> None:
    seen = [{"a": b"bc"}, {"ab": b"c"}, {"a": b"", "b": b"c"}, {"a": b"b", "c": b""}, {"a": b"bd"}]
    assert len({fingerprint(files) for files in seen}) == len(seen)
    assert fingerprint({"a": b"1", "b": b"2"}) == fingerprint({"b": b"2", "a": b"1"})


def test_load_raises_with_every_diagnostic(project: Path) -> None:
    (project / "motions/wave.yaml").write_text("")
    (project / "lumen.yaml").write_text("behavior: tuor\nlanguages: [en]\nrobot: {model: tiny}\n")
    with pytest.raises(ProjectError) as caught:
        lumen.load(project)
    assert {"empty-file", "unknown-behavior"} <= {d.code for d in caught.value.diagnostics}


def test_a_folder_called_like_a_file(project: Path) -> None:
    (project / "motions/bow.yaml").mkdir()
    assert codes(project) == ["unreadable-file"]


def test_links_in_a_circle_and_into_nothing(project: Path) -> None:
    (project / "motions/a.yaml").symlink_to("b.yaml")
    (project / "motions/b.yaml").symlink_to("a.yaml")
    (project / "fuzzy/gone.yaml").symlink_to("nowhere.yaml")
    assert codes(project) == ["unreadable-file"] * 3


def test_a_folder_that_is_a_link_in_a_circle(project: Path) -> None:
    shutil.rmtree(project / "motions")
    (project / "motions").symlink_to("motions")
    assert codes(project) == ["missing-folder"]


def test_a_pipe_is_not_waited_for(project: Path) -> None:
    os.mkfifo(project / "behaviors/pipe.yaml")
    assert codes(project) == ["unreadable-file"]


def test_a_huge_file_is_not_read(project: Path) -> None:
    with (project / "motions/long.yaml").open("wb") as file:
        file.truncate(2_000_000_000)
    assert codes(project) == ["unreadable-file"]


def test_what_an_editor_leaves_is_not_read(project: Path) -> None:
    (project / "motions/.#wave.yaml").symlink_to("somebody@somewhere.1234")
    (project / "motions/wave.yaml~").write_text("{{{")
    (project / "motions/.wave.yaml.swp").write_bytes(b"\x00")
    assert codes(project) == []


def test_a_name_that_is_not_utf8(project: Path) -> None:
    path = os.fsencode(project / "motions") + b"/b\xff.yaml"
    with open(path, "wb") as file:
        file.write(b"")
    [found] = lumen.check(project)
    assert found.code == "empty-file"
    found.place.file.encode()


def test_an_unreadable_main_file(project: Path) -> None:
    files = {**read_files(project), "lumen.yaml": Unreadable(b"permission denied")}
    _, diagnostics = check_files(project, files)
    assert [(d.code, d.place.file) for d in diagnostics] == [("unreadable-file", "lumen.yaml")]
    assert "permission denied" in diagnostics[0].message


def test_a_project_is_found_from_below(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(project / "behaviors" / "stories")
    assert find_project() == project
    assert find_project(project / "lumen.yaml") == project
    monkeypatch.chdir(project.parent)
    assert find_project() == shipped_root()


@pytest.mark.parametrize("name", ["nothing", "project/motions/wave.yaml", "a\0b"])
def test_what_is_no_folder(project: Path, name: str) -> None:
    with pytest.raises(UsageError):
        find_project(project.parent / name)


def test_the_public_names() -> None:
    assert all(getattr(lumen, name) is not None for name in lumen.__all__)
    with pytest.raises(AttributeError):
        lumen.nothing  # noqa: B018


def test_what_is_remembered_of_a_file_is_the_same_the_second_time() -> None:
    content = b"states: {a: {entry: {say: Hi}}, a: {}}\n"
    first, found = parse("behaviors/a.yaml", content)
    found.clear()
    again, said = parse("behaviors/a.yaml", content)
    assert again == first
    assert [d.code for d in said] == ["duplicate-key"]
