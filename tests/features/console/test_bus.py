"""The bus fails and comes back: the console reconnects, and each entry comes exactly once."""

import os
import signal
import sys
from pathlib import Path

import pytest

from lumen.features.console import commands
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served, Stream
from tests.guarded import DEVNULL, PIPE, Guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import until

SENT_TIMEOUT = commands.SENT_TIMEOUT


def whole(positions: list[str]) -> bool:
    """Return whether the positions have no gap and no duplicate."""
    numbers = [int(position) for position in positions]
    return numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_an_exhibition_that_is_begun_again_is_gone_on_with(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = Hosted(copy)
    served = Served(copy)
    try:
        with Stream(served.browser, "/api/events?after=-1") as stream:
            until(lambda: stream.of("entry"))
            first.close()
            until(lambda: not served.browser.robots[0]["connected"])
            with monkeypatch.context() as patch:
                patch.setattr(commands, "SENT_TIMEOUT", SENT_TIMEOUT)
                assert served.browser.command("rest", robot="NAO").data["state"] == "unsent"
            before = len(stream.of("entry"))
            second = Hosted(copy)
            try:
                until(lambda: len(stream.of("entry")) > before)
                assert served.browser.command("rest").data["state"] == "finished"
                until(lambda: "stop" in [event.data.get("heard") for event in stream.of("entry")[before:]])
            finally:
                second.close()
            assert whole(stream.positions())
    finally:
        served.close()


def test_a_console_that_is_begun_again_goes_on_after_what_a_page_has(hosted: Hosted) -> None:
    served = Served(hosted.root)
    with Stream(served.browser, "/api/events?after=-1") as stream:
        until(lambda: stream.of("entry"))
        served.browser.command("rest")
        until(lambda: len(stream.of("entry")) > 1)
    seen, port = stream.positions(), served.browser.port
    served.close()
    hosted.exhibition.resume()
    again = Served(hosted.root, port)
    try:
        with Stream(again.browser, Last_Event_ID=seen[-1]) as stream:
            until(lambda: "resume" in [event.data.get("heard") for event in stream.of("entry")])
        assert whole([*seen, *stream.positions()])
    finally:
        again.close()


@pytest.mark.slow
def test_a_broker_that_is_away_is_said_and_gone_on_with(
    copy: Path, own_broker: RabbitMQ, monkeypatch: pytest.MonkeyPatch
) -> None:
    hosted = Hosted(copy, own_broker.url)
    served = Served(copy, bus=own_broker.url)
    browser = served.browser
    try:
        until(lambda: [robot["connected"] for robot in browser.robots] == [True])
        [robot] = browser.robots
        until(lambda: browser.robots[0]["processes"])
        with Stream(browser, "/api/events?after=-1") as stream:
            until(lambda: stream.of("entry"))
            own_broker.kill()
            until(lambda: not browser.robots[0]["connected"])
            with monkeypatch.context() as patch:
                patch.setattr(commands, "SENT_TIMEOUT", SENT_TIMEOUT)
                assert browser.command("rest", robot=robot["robot"]).data["state"] == "unsent"
                assert browser.command("say", text="Hello").data["state"] == "unsent"
            own_broker.start()
            until(lambda: browser.robots[0]["connected"])
            until(lambda: browser.command("rest").data["state"] == "finished")  # its robot may be heard of late
            until(lambda: "stop" in [event.data.get("heard") for event in stream.of("entry")])
        assert whole(stream.positions())
    finally:
        served.close()
        hosted.close()


@pytest.mark.slow
def test_a_robot_whose_process_is_gone_is_not_said_to_rest(copy: Path, broker: RabbitMQ) -> None:
    command = [sys.executable, "-m", "lumen", "run", copy, "--bus", broker.url, "--robot", "recording", "--only"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with (
        Guarded([*command, "robot"], stdout=DEVNULL, stdin=PIPE, env=environment) as robot,
        Guarded([*command, "brain"], stdout=DEVNULL, stdin=PIPE, env=environment) as brain,
    ):
        served = Served(copy, bus=broker.url)
        browser = served.browser
        try:
            until(lambda: any("robot" in p["parts"] for r in browser.robots for p in r["processes"]))
            until(lambda: browser.robots[0]["connected"])
            until(lambda: browser.command("rest").data["state"] == "finished")
            browser.command("resume")
            os.killpg(robot.pid, signal.SIGKILL)
            robot.wait()
            with Stream(browser, "/api/events") as stream:
                answer = browser.command("rest")
                assert answer.data["state"] in ("unsent", "failed")
                assert "may still move" in answer.data["reason"] or "nobody is there" in answer.data["reason"]
                until(lambda: "stop" in [event.data.get("heard") for event in stream.of("entry")])
        finally:
            served.close()
            os.killpg(brain.pid, signal.SIGKILL)
            brain.wait()
