"""Reading a project: every file once, and nothing that a file system can do raises."""

import os
import shutil
import socket
from pathlib import Path

import pytest

import lumen
import lumen.fuzzy as lumen_fuzzy
import lumen.motion as lumen_motion
from lumen import statechart
from lumen.cli.main import main
from lumen.errors import ProjectError, UsageError
from lumen.lint import check_files
from lumen.project import files as project_files
from lumen.project.files import Unreadable, fingerprint, read_files
from lumen.project.packaged import find_project, shipped_root
from lumen.project.yaml_reader import parse
from lumen.upkeep.regular_files import read_regular
from tests import ROOT
from tests.copying import copied_project

BASE = ROOT / "tests/lint/base"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    copied_project(BASE, tmp_path / "project")
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
    assert loaded.stories["hello"].clock.text == "09:30"
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
    assert codes(project) == ["unreadable-file"]


def test_a_pipe_is_not_waited_for(project: Path) -> None:
    os.mkfifo(project / "behaviors/pipe.yaml")
    assert codes(project) == ["unreadable-file"]


def test_a_huge_file_is_not_read(project: Path) -> None:
    with (project / "motions/long.yaml").open("wb") as file:
        file.truncate(2_000_000_000)
    assert codes(project) == ["unreadable-file"]


SECRET = "TOKEN=tops3cret\nstates: {a: {on: {tops3cret: b}}}\n"


@pytest.fixture
def secret(tmp_path: Path) -> Path:
    """A file outside of the project, and a folder of such."""
    folder = tmp_path / "secrets"
    folder.mkdir()
    for name in ("s.yaml", "s.schema.json", "s.xml", "tops3cret.yaml"):
        (folder / name).write_text(SECRET)
    return folder


@pytest.mark.parametrize("link", [
    "behaviors/s.yaml", "behaviors/stories/s.yaml", "fuzzy/s.yaml", "motions/s.yaml", "models/s.yaml",
    "models/s.xml", "models/passages/s.yaml", "schemas/messages/s.schema.json", "lumen.yaml",
])  # fmt: skip
def test_a_link_that_leads_out_is_refused_and_shows_nothing(
    project: Path, secret: Path, link: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / link).parent.mkdir(exist_ok=True)
    (project / link).unlink(missing_ok=True)
    (project / link).symlink_to(secret / f"s{''.join(Path(link).suffixes)}")
    if link == "models/s.xml":
        settings = (project / "lumen.yaml").read_text()
        (project / "lumen.yaml").write_text(settings + "hall: s.xml\n" if "hall:" not in settings else settings)
    assert "unreadable-file" in codes(project) or link == "models/s.xml"
    for format in ("text", "concise", "json", "sarif", "github", "junit"):
        main(["lint", str(project), "--format", format])
    shown = capsys.readouterr()
    assert "s3cret" not in shown.out + shown.err


@pytest.mark.parametrize("folder", ["behaviors", "behaviors/stories", "fuzzy", "motions", "models", "schemas"])
def test_a_folder_that_leads_out_is_refused_and_shows_no_names(
    project: Path, secret: Path, folder: str, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(project / folder)
    (project / folder).symlink_to(secret)
    [found] = [d for d in lumen.check(project) if d.code == "unreadable-file"]
    assert found.place.file == folder
    assert "missing-folder" not in codes(project)
    main(["lint", str(project)])
    shown = capsys.readouterr()
    assert "s3cret" not in shown.out + shown.err
    assert str(secret) not in shown.out + shown.err


def test_links_within_the_project_are_followed(project: Path, tmp_path: Path) -> None:
    (project / "motions/wave.yaml").rename(project / "wave.yaml")
    (project / "motions/wave.yaml").symlink_to("../wave.yaml")
    (project / "fuzzy").rename(project / "controllers")
    (project / "fuzzy").symlink_to("controllers")
    assert codes(project) == []
    (tmp_path / "other").symlink_to(project)
    assert codes(tmp_path / "other") == []


def test_a_project_of_many_large_files_is_not_read_without_end(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(9):
        (project / f"motions/long{number}.yaml").write_bytes(b"#" * 1_000)
    monkeypatch.setattr(project_files, "MAX_FOLDER_FILES", 5)
    assert sum(file.startswith("motions/") for file in read_files(project)) == 5
    monkeypatch.setattr(project_files, "MAX_PROJECT_BYTES", 8_000)
    files = read_files(project)
    refused = {content for content in files.values() if isinstance(content, Unreadable)}
    assert refused == {b"the project holds more than 0 MB"}
    assert sum(len(content) for content in files.values() if not isinstance(content, Unreadable)) <= 8_000


@pytest.mark.parametrize("kind", ["pipe", "socket", "folder", "large"])
def test_what_is_no_plain_file_is_refused_at_once(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "here"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "socket":
        socket.socket(socket.AF_UNIX).bind(str(path))
    elif kind == "folder":
        path.mkdir()
    else:
        path.write_bytes(b"x" * 101)
    with pytest.raises(OSError):  # noqa: PT011  each has a reason of its own
        read_regular(path, 100)
    for load in (lumen_fuzzy.Controller.load, lumen_motion.Motion.load, statechart.Machine.load):
        with pytest.raises((UsageError, ProjectError)):
            load(path)


def test_a_device_is_refused_and_a_link_where_none_is_wanted(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="a device or a pipe"):
        read_regular(Path("/dev/zero"), 100)
    (tmp_path / "file").write_bytes(b"here")
    (tmp_path / "link").symlink_to("file")
    assert read_regular(tmp_path / "link", 4) == b"here"
    with pytest.raises(OSError, match="symbolic links"):
        read_regular(tmp_path / "link", 4, follow=False)


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
