"""*Keep as a test* on the page Day: an author's click writes the story of a visit, which `lumen test` then plays."""

import errno
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from unittest.mock import Mock

import pytest
from selenium.webdriver.common.keys import Keys

from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.features.console import kept_stories
from lumen.features.console.people import Role
from lumen.project.project_folders import STORIES
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.tour.conftest import copied
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("operating")]
PINS = {Role.OPERATOR: "1111", Role.AUTHOR: "2222"}
DIALOG = "dialog #keep-story"


@pytest.fixture(scope="module")
def visited(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hosted]:
    """An exhibition that Budi visits."""
    with closing(Hosted(copied(tmp_path_factory.mktemp("visited")))) as hosted:
        hosted.send("face", {"x": 160, "y": 120})
        until(lambda: "ask_name" in hosted.exhibition.configuration, HANG)
        hosted.send("heard", {"result": "my name is Budi", "language": "en"})
        until(lambda: hosted.exhibition.context["visitor"] == "Budi", HANG)
        yield hosted


@pytest.fixture(scope="module")
def console(visited: Hosted) -> Iterator[str]:
    with closing(Served(visited.root)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots), HANG)
        until(lambda: served.browser.get("/api/day").data["visits"], HANG)
        yield served.console.address


def kept(root: Path) -> set[Path]:
    """The stories that the console has written."""
    return {*(root / STORIES).glob("visit_2*.yaml")}


def keep(viewer: Viewer, name: str) -> None:
    """Click *Keep as a test*, and type the visitor's other name."""
    viewer.click(".keep-story button")
    until(lambda: viewer.run("return document.activeElement.matches('#keep-story input')"), HANG)
    viewer.type(name, Keys.ENTER)


def test_a_click_writes_a_story_that_passes(viewer: Viewer, visited: Hosted, console: str) -> None:
    before = kept(visited.root)
    viewer.open(console, "robot/NAO/day", ready=".keep-story button", mode="author")
    viewer.click(".keep-story button")
    until(lambda: viewer.run("return document.activeElement.matches('#keep-story input')"), HANG)
    assert violations(viewer) == []
    viewer.type("Ani", Keys.ENTER)
    viewer.shows("saved as behaviors/stories/visit_2", ".keep-story")
    until(lambda: not viewer.all(DIALOG), HANG)
    [story] = kept(visited.root) - before
    text = story.read_text("utf-8")
    assert "Ani" in text
    assert "Budi" not in text
    assert main(["test", str(visited.root), story.stem]) == 0


def test_a_second_click_with_the_same_name_writes_a_file_of_its_own(
    viewer: Viewer, visited: Hosted, console: str
) -> None:
    viewer.open(console, "robot/NAO/day", ready=".keep-story button", mode="author", language="id")
    keep(viewer, "Ani")
    viewer.shows("disimpan sebagai behaviors/stories/visit_2", ".keep-story")
    viewer.until(lambda: not viewer.all(DIALOG))
    first = {file: file.read_bytes() for file in kept(visited.root)}
    keep(viewer, "Ani")
    viewer.until(lambda: kept(visited.root) - first.keys())
    [second] = kept(visited.root) - first.keys()
    viewer.shows(second.name, ".keep-story > [role=status]")
    assert {file: file.read_bytes() for file in first} == first


def test_a_name_must_be_given(viewer: Viewer, visited: Hosted, console: str) -> None:
    before = kept(visited.root)
    viewer.open(console, "robot/NAO/day", ready=".keep-story button", mode="author")
    keep(viewer, "")
    assert viewer.all(DIALOG)
    viewer.type("   ", Keys.ENTER)
    viewer.shows("write another name for Budi: a story is kept for years", "dialog [role=alert]")
    assert kept(visited.root) == before


def test_a_refused_write_is_reported_and_the_name_stays(viewer: Viewer, visited: Hosted, console: str) -> None:
    folder, aside = visited.root / STORIES, visited.root / "behaviors" / "aside"
    viewer.open(console, "robot/NAO/day", ready=".keep-story button", mode="author", language="id")
    folder.rename(aside)
    folder.symlink_to(aside)
    try:
        keep(viewer, "Ani")
        viewer.shows("behaviors/stories/ adalah tautan simbolik: ganti dengan folder", "dialog [role=alert]")
        assert viewer.run("return document.querySelector('#keep-story input').value") == "Ani"
    finally:
        folder.unlink()
        aside.rename(folder)
    viewer.click("dialog .actions .strong")
    viewer.shows("disimpan sebagai behaviors/stories/visit_2", ".keep-story")


def test_a_full_disk_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_stories, "create_file", Mock(side_effect=OSError(errno.ENOSPC, "No space left on device")))
    with pytest.raises(UsageError, match="behaviors/stories/ can't be written: No space left on device"):
        kept_stories._created(tmp_path, "visit", "")


def test_a_folder_of_stories_that_is_a_link_is_not_written_to(tmp_path: Path) -> None:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors/stories").symlink_to(tmp_path, target_is_directory=True)
    with pytest.raises(UsageError, match="behaviors/stories/ is a symbolic link: replace it with a folder"):
        kept_stories._created(tmp_path, "visit", "")
    assert list(tmp_path.glob("*.yaml")) == []


def test_only_an_author_sees_it(viewer: Viewer, visited: Hosted, console: str) -> None:
    viewer.open(console, "robot/NAO/day", ready=".day .entry", mode="operator")
    assert not viewer.all(".keep-story")
    with closing(Served(visited.root, pins=PINS)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots), HANG)
        browser, before = Browser(served.console.address), kept(visited.root)
        story = {"position": 1, "visitor": "Budi", "name": "Ani"}
        for pin in ({}, {"Authorization": f"Bearer {PINS[Role.OPERATOR]}"}):
            assert browser.post("/api/stories", story, **pin).status in (401, 403)
        assert kept(visited.root) == before
