"""Untrusted input: foreign pages in the same browser, guesses of PINs, users without a role, words of visitors."""

import http.client
import json
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

import pytest

from lumen.features.console.orders import NEEDS
from lumen.features.console.people import Role
from tests.features.console.chromium import Chromium
from tests.features.console.conftest import Hosted
from tests.features.console.pages import JSON, Browser, Served, Stream
from tests.servers import EVIL
from tests.waiting import HANG, until

PIN = "0500"
NAME = "Zebulon"
SCRIPT = "<script>alert(1)</script>"
PAGES = ("", "robot/NAO", "robot/NAO/day", "robot/NAO/files", "robot/NAO/see", "robot/NAO/subtitles")
ATTACK = """
const [console, done] = [arguments[0], arguments[arguments.length - 1]];
const body = JSON.stringify({ id: `evil-${location.hostname}`, robot: "NAO", command: "rest" });
const image = (path) => new Promise((told) => Object.assign(new Image(), {
  onload: () => told(true), onerror: () => told(false), src: console + path }));
const read = (path, how) =>
  fetch(console + path, how).then((answer) => answer.text()).then((text) => text !== "", () => false);
const listen = () => new Promise((told) => Object.assign(new EventSource(console + "api/events"), {
  onopen: () => told(true), onerror: () => told(false) }));
Promise.all([
  read("api/commands", { method: "POST", mode: "no-cors", body }),
  read("api/commands", { method: "POST", body }),
  read("api/commands", { method: "POST", headers: { "Content-Type": "application/json" }, body }),
  read("api/now"), read("api/now", { credentials: "include" }), read("pages/rest.js"),
  image("camera/NAO"), image("pages/look/icon.svg"), listen(),
]).then(done);
"""
OWN = """
const [id, done] = arguments, body = JSON.stringify({ id, robot: "NAO", command: "rest" });
fetch("/api/commands", { method: "POST", headers: { "Content-Type": "application/json" }, body })
  .then((answer) => answer.json()).then((said) => done(said.state));
"""


class Foreign(BaseHTTPRequestHandler):
    """A page from a foreign server."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b"<!doctype html><title>not ours</title>")

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def foreign() -> Iterator[int]:
    """The port of a server with foreign pages."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Foreign) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join()


@pytest.fixture
def locked(hosted: Hosted) -> Iterator[Browser]:
    """A console that requires a PIN."""
    served = Served(hosted.root, pins={Role.OPERATOR: PIN})
    until(lambda: any(robot["connected"] for robot in served.browser.robots))
    yield served.browser
    served.close()


def meet(hosted: Hosted, name: str) -> None:
    """Let a visitor come whose face the robot recognises as `name`."""
    hosted.exhibition.send("face", {"x": 160, "y": 120})
    until(lambda: "greet" in hosted.exhibition.configuration, HANG)
    hosted.exhibition.send("recognised", {"name": name})
    until(lambda: hosted.exhibition.context.get("visitor") == name, HANG)


@pytest.mark.slow
@pytest.mark.parametrize("host", ["127.0.0.1", EVIL])
def test_a_page_of_somebody_else_reads_nothing_and_does_nothing(
    served: Served, hosted: Hosted, chromium: Chromium, foreign: int, host: str
) -> None:
    chromium.open(f"http://{host}:{foreign}/")
    until(lambda: chromium.run("return document.title") == "not ours", HANG)
    got = chromium.driver.execute_async_script(ATTACK, served.console.address)
    assert got == [False] * 9
    assert hosted.exhibition.robot.server.hold.stopped is None
    chromium.open(served.console.address)  # and what it tried was no mistake
    chromium.find("rest-button[main] button.rest")
    assert chromium.driver.execute_async_script(OWN, f"own-{host}") == "finished"
    assert hosted.exhibition.robot.server.hold.stopped


@pytest.mark.slow
def test_a_name_that_somebody_has_bound_to_this_address_is_refused(served: Served, chromium: Chromium) -> None:
    chromium.open(f"http://{EVIL}:{served.browser.port}/")
    until(lambda: chromium.shows("unknown host"), HANG)
    assert chromium.all("rest-button") == []


@pytest.mark.slow
def test_a_visitor_called_like_a_script_is_a_name_on_every_page(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    meet(hosted, SCRIPT)
    until(lambda: served.browser.robots[0]["visitor"] == SCRIPT)
    for page in PAGES:
        chromium.open(served.console.address + page)
        until(
            lambda: chromium.run(
                "return document.readyState === 'complete' && document.querySelector('main')?.innerText"
            )
        )
        if page in PAGES[:3]:
            until(lambda: SCRIPT in chromium.text(), HANG)
        assert not chromium.run("return [...document.scripts].some((one) => one.text.includes('alert'))")
    chromium.open(served.console.address)
    chromium.find(".entry button")
    chromium.click(".entry button", SCRIPT)
    until(
        lambda: chromium.run("return document.querySelector('dialog[open]')?.innerText.includes(arguments[0])", SCRIPT)
    )


@pytest.mark.usefixtures("still")
def test_a_thousand_tries_in_a_row_get_nobody_in_and_rest_goes_on(locked: Browser, hosted: Hosted) -> None:
    """The tries come from many addresses, and one of them has the right PIN."""
    statuses = [tried(locked, number, f"127.0.{number % 4}.{1 + number % 250}") for number in range(1_000)]
    looked_at = sum(status == 401 for status in statuses)
    assert set(statuses) == {401, 429}
    assert looked_at < 30
    assert locked.command("rest", robot="NAO").data["state"] == "finished"
    assert hosted.exhibition.robot.server.hold.stopped


def test_show_presses_what_is_there_and_breaks_nothing(hosted: Hosted) -> None:
    """The role is refused all commands and paths of other roles, even if their content is valid."""
    served = Served(hosted.root, pins={Role.SHOW: PIN, Role.AUTHOR: f"{PIN}-author"})
    browser, show = served.browser, {"Authorization": f"Bearer {PIN}"}
    try:
        until(lambda: any(robot["connected"] for robot in browser.robots))
        before = hosted.exhibition.configuration
        fields = {
            "text": "Boo",
            "name": "dance",
            "state": "dance",
            "level": "alone",
            "event": "face",
            "data": {"x": 1, "y": 1},
        }
        for command in sorted(set(NEEDS) - {"rest", "mark", "approve"}):
            answer = browser.post(
                "/api/commands", {"id": command, "robot": "NAO", "command": command, **fields}, **show
            )
            assert (answer.status, "role" in answer.data["reason"]) == (403, True), command
        for path in ("api/day", "api/day.csv", "api/entries?from=0&to=9", "api/files"):
            assert browser.get(f"/{path}", **show).status == 403, path
        assert browser.post("/api/fork", {"robot": "NAO", "position": 1}, **show).status == 403
        assert hosted.exhibition.configuration == before
        assert browser.get("/api/now", **show).data["robots"][0]["autonomy"] == "ask"
        mark = {"id": "m", "robot": "NAO", "command": "mark", "text": "he waved"}
        assert browser.post("/api/commands", mark, **show).data["state"] == "finished"
        go = {"id": "g", "robot": "NAO", "command": "approve", "approval": "a1", "go": True}
        assert browser.post("/api/commands", go, **show).data["state"] == "failed"  # nothing waits
    finally:
        served.close()


def tried(browser: Browser, number: int, source: str) -> int:
    """Send a PIN from a loopback address, and return the HTTP status."""
    connection = http.client.HTTPConnection(browser.host, browser.port, timeout=HANG, source_address=(source, 0))
    try:
        connection.request("POST", "/api/session", json.dumps({"pin": f"{number:04}"}), JSON)
        return connection.getresponse().status
    finally:
        connection.close()


def test_nobody_hears_a_name_or_sees_an_image(locked: Browser, hosted: Hosted) -> None:
    """The screen beside the robot shows its spoken words, which the hall hears anyway, but without the name."""
    meet(hosted, NAME)
    signed_in = {"Authorization": f"Bearer {PIN}"}
    until(lambda: locked.get("/api/now", **signed_in).data["robots"][0]["visitor"] == NAME)
    with Stream(locked) as stream:
        hosted.exhibition.say(f"Goodbye {NAME.upper()}, and {NAME}!", "en")
        until(lambda: any("Goodbye …, and …!" in str(event.data["saying"]) for event in stream.of("now")), HANG)
        until(lambda: stream.comments > 2)
    assert stream.of("now")
    assert stream.of("entry") == stream.of("command") == []
    told = [event.data for event in stream.of("now")] + list(locked.robots)
    assert NAME not in json.dumps(told)
    for path in ("camera/NAO", "api/day", "api/day.csv", "api/entries?from=0&to=9", "api/why?what=greet", "api/files"):
        answer = locked.get(f"/{path}")
        assert (answer.status, NAME in answer.body.decode()) == (401, False), path
    assert locked.get("/api/day", **signed_in).status == 200


@pytest.mark.slow
def test_a_page_without_a_role_shows_rest_and_no_name(locked: Browser, hosted: Hosted, chromium: Chromium) -> None:
    meet(hosted, NAME)
    chromium.open(f"http://127.0.0.1:{locked.port}/robot/NAO")
    until(lambda: chromium.shows("Sign in"), HANG)
    assert NAME not in chromium.text()
    assert chromium.all("main img") == []
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    assert hosted.exhibition.robot.server.hold.stopped
