"""A page receives the robot's state, the entries of the journal, and the result of each command."""

import pytest

from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Stream
from tests.waiting import until


@pytest.mark.once
def test_it_says_how_each_robot_is(browser: Browser, hosted: Hosted) -> None:
    said = browser.get("/api/now").data
    [robot] = said["robots"]
    assert (said["role"], robot["robot"], robot["connected"]) == ("author", "NAO", True)
    assert set(robot) >= set(hosted.exhibition.status())


@pytest.mark.once
def test_rest_is_done_when_the_robot_says_so(browser: Browser, hosted: Hosted) -> None:
    answer = browser.command("rest", robot="NAO")
    assert (answer.status, answer.data["state"], answer.headers["lumen-state"]) == (200, "finished", "sent")
    assert hosted.exhibition.robot.server.hold.stopped
    assert browser.command("resume").data["state"] == "finished"
    until(lambda: not hosted.exhibition.robot.server.hold.stopped)


def test_entries_come_once_in_order_with_the_positions_of_the_journal(browser: Browser, hosted: Hosted) -> None:
    with Stream(browser, "/api/events?after=-1") as stream:
        until(lambda: stream.of("entry"))
        browser.command("rest")
        browser.command("resume")
        until(lambda: "resume" in [event.data.get("heard") for event in stream.of("entry")])
    positions = [int(position) for position in stream.positions()]
    assert positions == list(range(len(positions)))
    with Stream(browser, Last_Event_ID="0") as again:
        until(lambda: again.of("entry"))
    assert again.positions()[0] == "1"
    told = [(event.data["command"], event.data["state"]) for event in stream.of("command")]
    assert told[:1] == [("rest", "sent")]


def test_a_command_that_comes_again_is_the_same_one(browser: Browser, hosted: Hosted) -> None:
    first = browser.command("say", id="once", text="Hello")
    assert browser.command("say", id="once", text="Hello").data == first.data
    assert first.data["state"] == "finished"
