"""Requests of a foreign page, a rebound host name, a guesser of PINs or a careless program, and their answers."""

import json
import socket
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from lumen.errors import UsageError
from lumen.features.console import requests
from lumen.features.console.access import Access, TooFastError, pins_from
from lumen.features.console.gate import MAX_BODY
from lumen.features.console.people import Person, Role
from lumen.features.console.proxies import TrustedProxies
from lumen.features.console.requests import REQUESTS_PER_SECOND
from lumen.features.console.serving import Console
from lumen.upkeep.ratelimit import BURST, RateLimiter
from tests.features.console.pages import Browser, Served, Stream
from tests.tables import for_each
from tests.waiting import HANG, until

PINS = {Role.SHOW: "show-1", Role.OPERATOR: "operator-2", Role.AUTHOR: "author-3"}
REST = {"id": "r", "robot": "NAO", "command": "rest"}


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A console without an exhibition, and with PINs."""
    served = Served(tmp_path_factory.mktemp("nobody"), pins=PINS)
    yield served.browser
    served.close()


@pytest.fixture(scope="module")
def open_to_all(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A console without an exhibition, and without PINs."""
    served = Served(tmp_path_factory.mktemp("nobody"))
    yield served.browser
    served.close()


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1.evil.example", "localhost@evil", "", "0.0.0.0", "127.0.0.1:x"]
)
def test_a_name_that_is_not_ours_is_refused(open_to_all: Browser, host: str) -> None:
    answer = open_to_all.get("/api/now", Host=host)
    assert answer.status == 421
    assert "unknown host" in answer.data["reason"]


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1:1", "[::1]:8080"])
def test_names_of_this_machine_are_ours(open_to_all: Browser, host: str) -> None:
    assert open_to_all.get("/api/now", Host=host).status == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "http://localhost"])
def test_pages_of_others_may_not_ask(open_to_all: Browser, origin: str) -> None:
    assert open_to_all.post("/api/commands", REST, Origin=origin).status == 403
    assert open_to_all.get("/api/events", Origin=origin).status == 403
    assert open_to_all.get("/camera/NAO", Sec_Fetch_Site="cross-site").status == 403
    ours = f"http://{open_to_all.host}:{open_to_all.port}"
    assert open_to_all.post("/api/commands", REST, Origin=ours).data["state"] == "unsent"


def test_only_json_objects_of_some_size_are_taken(open_to_all: Browser) -> None:
    assert open_to_all.ask("POST", "/api/commands", b"id=1", Content_Type="text/plain").status == 415
    for body in (b"", b"[1]", b"{", b"\xff", b"[" * 50_000):
        answer = open_to_all.ask("POST", "/api/commands", body, Content_Type="application/json")
        assert (answer.status, set(answer.data)) == (400, {"reason"})
    large = json.dumps({**REST, "text": "x" * MAX_BODY}).encode()
    assert open_to_all.ask("POST", "/api/commands", large, Content_Type="application/json").status == 413


@pytest.mark.parametrize(
    "body",
    [
        {"command": "rest"},
        {"id": "a b", "command": "rest", "robot": "NAO"},
        {"id": "1", "command": "explode"},
        {"id": "1", "command": ["rest"]},
        {"id": 1, "command": "say", "robot": "NAO", "text": "x"},
    ],
)
def test_what_is_wrong_with_a_command_is_said_in_a_sentence(open_to_all: Browser, body: object) -> None:
    answer = open_to_all.post("/api/commands", body)
    assert answer.status == 400
    assert answer.data["reason"]


def test_every_answer_has_the_headers_that_keep_others_out(open_to_all: Browser) -> None:
    for path in ("/", "/api/now", "/pages/rest.js", "/nowhere", "/robot/NAO/day"):
        headers = open_to_all.get(path).headers
        assert headers["content-security-policy"].startswith("default-src 'self'")
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert (headers["x-content-type-options"], headers["referrer-policy"]) == ("nosniff", "no-referrer")


@pytest.mark.parametrize(
    "path", ["../site.py", "..%2fsite.py", "%2e%2e/site.py", "/etc/passwd", "vendor/../../site.py"]
)
def test_nothing_but_pages_is_served(open_to_all: Browser, path: str) -> None:
    with socket.create_connection((open_to_all.host, open_to_all.port), 30) as wire:
        wire.sendall(f"GET /pages/{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        answer = b"".join(iter(lambda: wire.recv(65536), b""))
    assert b" 404 " in answer.splitlines()[0]


def test_without_a_role_one_may_rest_and_nothing_else(alone: Browser) -> None:
    now = alone.get("/api/now").data
    assert now["role"] == "nobody"
    for path in (
        "/camera/NAO",
        "/api/day",
        "/api/why",
        "/api/files",
        "/api/shape",
        "/api/poses?robot=NAO",
        "/api/entries",
    ):
        assert alone.get(path).status == 401, path
    assert alone.post("/api/fork", {}).status == 401
    assert alone.post("/api/fork", {}, Authorization="Bearer operator-2").status == 403
    assert alone.command("say", text="x", robot="NAO").status == 401
    assert alone.command("rest", robot="NAO").data["state"] == "unsent"


def test_a_pin_gives_a_role_and_a_session_keeps_it(alone: Browser) -> None:
    assert alone.get("/api/now", Authorization="Bearer operator-2").data["role"] == "operator"
    answer = alone.post("/api/session", {"pin": "show-1", "name": "Ada"})
    assert (answer.status, answer.data["role"]) == (200, "show")
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    value = cookie.partition(";")[0]
    now = alone.get("/api/now", Cookie=value).data
    assert (now["role"], now["name"]) == ("show", "Ada")
    assert alone.get("/api/now", Cookie=value[:-1] + ("0" if value[-1] != "0" else "1")).data["role"] == "nobody"
    assert alone.ask("DELETE", "/api/session", Cookie=value).status == 200
    assert alone.get("/api/now", Cookie=value).data["role"] == "nobody"


def test_a_session_outlives_the_console_but_not_its_pin() -> None:
    secret = b"x" * 32
    cookie = Access(PINS, secret).sign(Person(Role.AUTHOR, "Ada"))
    assert Access(PINS, secret).person("a", "", cookie) == (Role.AUTHOR, "Ada")
    assert Access({**PINS, Role.AUTHOR: "another"}, secret).person("a", "", cookie).role is Role.NOBODY
    assert Access(PINS, b"y" * 32).person("a", "", cookie).role is Role.NOBODY
    for broken in ("", ".", "a.b", "é.é", cookie.partition(".")[2]):
        assert Access(PINS, secret).person("a", "", broken).role is Role.NOBODY


@pytest.mark.usefixtures("still")
def test_pins_cannot_be_guessed_at_speed() -> None:
    access, tried = Access(PINS), 0
    for number in range(1_000):
        try:
            access.role("one", f"{number:04}")
            tried += 1
        except TooFastError as error:
            assert error.wait >= 1  # noqa: PT017  what is raised is what is asked about
    assert tried == 3
    for number in range(1_000):
        try:
            access.role(f"address {number}", f"{number:04}")
            tried += 1
        except TooFastError:
            break
    assert tried == 20


def test_rest_is_never_rationed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(requests, "RateLimiter", lambda: RateLimiter(lambda: 0.0))
    with closing(Served(tmp_path)) as served:
        browser, allowed = served.browser, int(BURST * REQUESTS_PER_SECOND)
        assert {browser.get("/api/now").status for _ in range(allowed)} == {200}
        assert browser.get("/api/now").status == 429
        assert {browser.command("rest", robot="NAO").status for _ in range(20)} == {200}


def test_nobody_else_is_let_in_without_pins(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no PINs are set"):
        Console(lambda: pytest.fail("no bus is wanted"), tmp_path, "0.0.0.0", 0)


@for_each(
    ("pins", "reason"),
    [
        ({}, r"the PIN for show is missing: set the environment variable \$SHOW"),
        ({"SHOW": "show-1", "OPERATOR": "123"}, r"the PIN for operator, in \$OPERATOR, is too short"),
        (
            {"SHOW": "show-1", "OPERATOR": "show-1"},
            r"the PIN for operator, in \$OPERATOR, is also the PIN of another role",
        ),
    ],
)
def test_each_role_needs_a_pin_of_its_own(pins: dict[str, str], reason: str) -> None:
    said = {"show": "$SHOW", "operator": "$OPERATOR"}
    assert pins_from(said, {"SHOW": "show-1", "OPERATOR": "operator-2"}) == {
        Role.SHOW: "show-1",
        Role.OPERATOR: "operator-2",
    }
    with pytest.raises(UsageError, match=reason):
        pins_from(said, pins)


def test_a_port_that_is_taken_is_said_in_a_line(open_to_all: Browser, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=f"port {open_to_all.port} of 127.0.0.1 is not available"):
        Console(lambda: pytest.fail("no bus is wanted"), tmp_path, "127.0.0.1", open_to_all.port)


def test_it_ends_at_once_with_pages_that_listen(tmp_path: Path) -> None:
    served = Served(tmp_path)
    streams = [Stream(served.browser) for _ in range(5)]
    until(lambda: all(stream.comments for stream in streams))
    served.close()
    for stream in streams:
        assert stream.ended.wait(HANG)
        stream.close()


@pytest.fixture(scope="module")
def behind(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A console whose trusted proxies connect from this machine, and from a network."""
    served = Served(tmp_path_factory.mktemp("nobody"), pins=PINS, proxies=["127.0.0.1", "10.0.0.0/8"])
    yield served.browser
    served.close()


def signs_in(browser: Browser, pin: str, **forwarded: str) -> int:
    return browser.post("/api/session", {"pin": pin}, **forwarded).status


@pytest.mark.usefixtures("still")
def test_wrong_pins_behind_a_proxy_cost_time_only_where_they_came_from(behind: Browser) -> None:
    guesser, neighbour = ({"X_Forwarded_For": f"10.0.0.7, 203.0.113.{n}, 10.0.0.2"} for n in (5, 6))
    statuses = [signs_in(behind, "wrong", **guesser) for _ in range(4)]
    assert statuses == [401, 401, 401, 429]
    assert signs_in(behind, "show-1", **neighbour) == 200
    assert signs_in(behind, "show-1", **guesser) == 429


@pytest.mark.usefixtures("still")
def test_nobody_but_a_trusted_proxy_is_believed(tmp_path: Path) -> None:
    """Otherwise a guesser of PINs could claim another address for each guess."""
    with closing(Served(tmp_path, pins=PINS)) as served:
        answer = served.browser.post("/api/session", {"pin": "show-1"}, X_Forwarded_Proto="https")
        assert answer.status == 200
        assert "secure" not in answer.headers["set-cookie"].lower()
        statuses = [signs_in(served.browser, "wrong", X_Forwarded_For=f"203.0.113.{n}") for n in range(4)]
        assert statuses == [401, 401, 401, 429]


@for_each(
    "client, forwarded, address",
    [
        ("127.0.0.1", [], "127.0.0.1"),
        ("127.0.0.1", ["203.0.113.5"], "203.0.113.5"),
        ("127.0.0.1", ["198.51.100.1, 203.0.113.5"], "203.0.113.5"),
        ("127.0.0.1", ["198.51.100.1", "203.0.113.5:4711, 10.1.2.3"], "203.0.113.5"),
        ("127.0.0.1", ["[2001:db8::1]:443"], "2001:db8::1"),
        ("127.0.0.1", ["::ffff:203.0.113.5"], "203.0.113.5"),
        ("127.0.0.1", ["203.0.113.5, unknown"], "127.0.0.1"),
        ("127.0.0.1", ["10.1.2.3"], "127.0.0.1"),
        ("::ffff:127.0.0.1", ["203.0.113.5"], "203.0.113.5"),
        ("192.0.2.1", ["203.0.113.5"], "192.0.2.1"),
    ],
)
def test_the_address_is_the_last_that_is_no_proxy(client: str, forwarded: list[str], address: str) -> None:
    headers = [(b"x-forwarded-for", value.encode()) for value in forwarded]
    scope = {"client": (client, 1), "headers": headers, "scheme": "http"}
    assert TrustedProxies(["127.0.0.1", "10.0.0.0/8"]).seen(scope)["client"][0] == address


def test_a_cookie_of_an_encrypted_session_is_never_sent_in_the_clear(behind: Browser) -> None:
    forwarded = {"X_Forwarded_For": "203.0.113.9"}
    for protocol, secure in (("https", True), ("http", False)):
        answer = behind.post("/api/session", {"pin": "show-1"}, **forwarded, X_Forwarded_Proto=protocol)
        assert ("secure" in answer.headers["set-cookie"].lower()) is secure
        gone = behind.ask("DELETE", "/api/session", **forwarded, X_Forwarded_Proto=protocol)
        assert ("secure" in gone.headers["set-cookie"].lower()) is secure


def test_a_proxy_needs_pins_and_an_address(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="through a proxy, but no PINs are set"):
        Console(lambda: pytest.fail("no bus is wanted"), tmp_path, "127.0.0.1", 0, proxies=["127.0.0.1"])
    with pytest.raises(UsageError, match=r"'proxy\.museum\.example' does not appear to be"):
        TrustedProxies(["proxy.museum.example"])


def test_the_folder_of_the_project_is_told_to_nobody(tmp_path: Path) -> None:
    root = tmp_path / "secret-place"
    root.mkdir()
    with closing(Served(root, pins=PINS)) as served:
        browser = served.browser
        until(lambda: "no exhibition of this project is running" in browser.get("/api/now").data["bus"])
        answers = [browser.get("/api/now"), browser.command("rest", robot="NAO"), browser.command("rest", robot="*")]
        answers.append(browser.get("/api/now", Authorization="Bearer show-1"))
        answers.append(browser.command("say", text="x", robot="NAO7"))
        assert [answer for answer in answers if b"secret-place" in answer.body] == []
