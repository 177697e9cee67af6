"""Sentences that operators store for the robot to say: of a project, each in its language."""

from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from selenium.webdriver.common.keys import Keys

from lumen.errors import UsageError
from lumen.features.console.prepared_sentences import (
    MAX_SENTENCES,
    PREPARED_FILE,
    PreparedSentence,
    PreparedSentences,
)
from lumen.project.home import home_of
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.waiting import until

WAIT, COME = PreparedSentence("Please wait.", "en"), PreparedSentence("Silakan masuk.", "id")


def kept(root: Path) -> PreparedSentences:
    reception: Any = SimpleNamespace()
    return PreparedSentences(reception, root)


def test_they_are_kept_in_their_order_once(tmp_path: Path) -> None:
    assert kept(tmp_path).all() == []
    for one in (WAIT, COME, PreparedSentence("  Please   wait. ", "en")):
        kept(tmp_path).keep(one)
    assert kept(tmp_path).all() == [WAIT, COME]
    assert kept(tmp_path).remove(WAIT) == [COME]
    assert kept(tmp_path).all() == [COME]


def test_invalid_ones_are_refused_and_change_nothing(tmp_path: Path) -> None:
    one = kept(tmp_path)
    one.keep(WAIT)
    for wrong in (
        PreparedSentence(" ", "en"),
        PreparedSentence("Hello", "no language"),
        PreparedSentence("x" * 2000, "en"),
    ):
        with pytest.raises(UsageError):
            one.keep(wrong)
    for number in range(1, MAX_SENTENCES):
        one.keep(PreparedSentence(f"Sentence {number}", "en"))
    with pytest.raises(UsageError, match="100 sentences are kept already"):
        one.keep(COME)
    assert len(one.all()) == MAX_SENTENCES


@pytest.mark.parametrize("content", [b"{", b"[1]", b'[{"text": "a"}]', b"\xff"])
def test_a_broken_file_is_named_and_left(tmp_path: Path, content: bytes) -> None:
    file = home_of(tmp_path) / PREPARED_FILE
    file.parent.mkdir(parents=True)
    file.write_bytes(content)
    with pytest.raises(UsageError, match="is broken: delete it"):
        kept(tmp_path).keep(WAIT)
    assert file.read_bytes() == content


@pytest.mark.slow
@pytest.mark.xdist_group("operating")
def test_an_operator_keeps_a_sentence_and_says_it_with_one_press(viewer: Viewer, copy: Path) -> None:
    with closing(Hosted(copy)), closing(Served(copy)) as served:
        until(lambda: [robot["connected"] for robot in served.browser.robots] == [True])
        viewer.open(served.console.address, "robot/NAO", ready=".say", mode="operator")
        viewer.click(".say input")
        viewer.type("Please come closer.")
        viewer.click(".keep-sentence")
        viewer.shows("Please come closer.", ".prepared")
        viewer.open(served.console.address, "robot/NAO", ready=".prepared li", mode="operator")  # another visit
        assert violations(viewer) == []
        viewer.click(".prepared-say")
        viewer.shows("Please come closer.", ".lines-of-talk")
        viewer.tells("Say “Please come closer.”: done")
        viewer.run("document.querySelector('.prepared li .plain').focus()")
        viewer.type(Keys.ENTER)
        until(lambda: not viewer.all(".prepared li"))
        refused = served.browser.post("/api/prepared", {"text": "a", "language": "en"})
        assert (refused.status, refused.data) == (400, {"reason": "`keep` must be true or false"})
