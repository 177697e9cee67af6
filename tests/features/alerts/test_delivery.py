"""An alert on its way: to the web, by mail, to a program; and why it did not arrive."""

import json
import os
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.errors import UndeliveredError
from lumen.features.alerts import ways
from lumen.features.alerts.alert import Alert, Origin
from lumen.features.alerts.desk import address, deliver
from lumen.features.alerts.settings import AlertChannel, Mail, Program, Webhook
from tests.certificates import certify
from tests.features.alerts.servers import Post, Web
from tests.waiting import until

ALERT = Alert("fallen", "it fell and has not got up", "", 1_000.0, 400.0, 3)
ORIGIN = Origin("Electrical Engineering Days", "NAO", ("robot", "brain"))
Webs = Callable[..., Web]


def send(channel: AlertChannel, root: Path = Path()) -> None:
    deliver(channel, ALERT, ORIGIN, root)


def undelivered(channel: AlertChannel, root: Path = Path()) -> UndeliveredError:
    with pytest.raises(UndeliveredError) as error:
        send(channel, root)
    assert "\n" not in str(error.value)
    return error.value


@pytest.mark.once
def test_a_webhook_gets_json(web: Webs, monkeypatch: pytest.MonkeyPatch) -> None:
    here = web()
    monkeypatch.setenv("LUMEN_ALERT_TOKEN", "secret")
    send(Webhook(here.url))
    [body], [head] = here.bodies, here.heads
    assert body["text"].startswith("NAO: it fell and has not got up (3 times since ")
    assert (body["kind"], body["count"], body["exhibition"]) == ("fallen", 3, "Electrical Engineering Days")
    assert (body["at"], body["first"]) == ("1970-01-01T00:16:40+00:00", "1970-01-01T00:06:40+00:00")
    assert (body["robot"], body["parts"], body["host"]) == ("NAO", ["robot", "brain"], os.uname().nodename)
    assert (head["Content-Type"], head["Authorization"]) == ("application/json", "Bearer secret")


@pytest.mark.parametrize(("status", "final"), [(500, False), (429, False), (404, True), (401, True), (302, True)])
def test_what_a_web_server_answers(web: Webs, status: int, final: bool) -> None:
    here = web(status)
    error = undelivered(Webhook(here.url))
    assert (str(error).startswith(f"the server answers {status}"), error.final) == (True, final)


def test_a_web_server_that_is_not_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    error = undelivered(Webhook(f"http://127.0.0.1:{port}/"))
    assert (str(error), error.final) == ("the server can't be reached: [Errno 111] Connection refused", False)


def test_an_address_from_the_environment_is_not_said(web: Webs, monkeypatch: pytest.MonkeyPatch) -> None:
    here = web()
    assert undelivered(Webhook("$LUMEN_ALERT_URL")).final
    monkeypatch.setenv("LUMEN_ALERT_URL", here.url)
    send(Webhook("$LUMEN_ALERT_URL"))
    assert len(here.bodies) == 1
    for secret in ("file:///etc/passwd", "http://127.0.0.1:x/very secret", "http://[very/secret"):
        monkeypatch.setenv("LUMEN_ALERT_URL", secret)
        said = str(undelivered(Webhook("$LUMEN_ALERT_URL")))
        assert "secret" not in said.replace("LUMEN", "")
        assert "passwd" not in said
    assert address(Webhook("https://chat.example/hooks/secret")) == "the webhook https://chat.example"


def mail(port: int, security: str = "none") -> Mail:
    return Mail("127.0.0.1", port, security, "lumen@example.org", ("day@example.org", "night@example.org"))


@pytest.mark.once
def test_a_mail() -> None:
    post = Post()
    send(mail(post.port))
    until(lambda: post.mails)
    [text] = post.mails
    assert "Subject: [Lumen] NAO: it fell and has not got up (3 times since" in text.replace("\r\n ", " ")
    assert "To: day@example.org, night@example.org" in text
    body = text.partition("\r\n\r\n")[2]
    assert json.loads(body[body.index("{") :])["kind"] == "fallen"
    post.close()


def test_a_mail_that_is_encrypted_and_logged_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    post = Post(certify(tmp_path, "IP:127.0.0.1"))
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "ca.pem"))
    monkeypatch.setenv("LUMEN_SMTP_USER", "lumen")
    monkeypatch.setenv("LUMEN_SMTP_PASSWORD", "secret")
    send(mail(post.port, "starttls"))
    assert post.users == ["/lumen/secret"]
    until(lambda: post.mails)
    monkeypatch.delenv("SSL_CERT_FILE")
    error = undelivered(mail(post.port, "starttls"))
    assert "certificate" in str(error).lower()
    assert post.users == ["/lumen/secret"], "nobody who can't prove who they are is told the password"
    post.close()


def test_a_password_is_never_sent_in_the_clear(monkeypatch: pytest.MonkeyPatch) -> None:
    post = Post()
    monkeypatch.setenv("LUMEN_SMTP_USER", "lumen")
    monkeypatch.setenv("LUMEN_SMTP_PASSWORD", "secret")
    error = undelivered(mail(post.port))
    assert error.final
    assert "is not sent unencrypted" in str(error)
    error = undelivered(mail(post.port, "starttls"))
    assert "STARTTLS" in str(error)
    assert post.users == []
    post.close()


@pytest.mark.parametrize(
    ("answers", "said", "final"),
    [
        ({"RCPT": "550 nobody here"}, "the mail server refuses day@example.org, night@example.org", True),
        ({"RCPT": "451 later"}, "the mail server refuses day@example.org, night@example.org", False),
        ({"DATA": "554 no"}, "the mail server answers 554 no", True),
        ({"MAIL": "421 busy"}, "the mail server answers 421 busy", False),
    ],
)
def test_what_a_mail_server_answers(answers: dict[str, str], said: str, final: bool) -> None:
    post = Post(**answers)
    error = undelivered(mail(post.port))
    assert (str(error), error.final) == (said, final)
    post.close()


def script(root: Path, text: str) -> Program:
    (root / "page.py").write_text(text)
    return Program((sys.executable, "page.py", "a b", "$HOME; x"))


@pytest.mark.once
def test_a_program_gets_json_and_its_words_as_they_are(tmp_path: Path) -> None:
    command = script(tmp_path, "import sys; open('got','w').write(sys.stdin.read() + '|' + '|'.join(sys.argv[1:]))")
    send(command, tmp_path)
    body, *words = (tmp_path / "got").read_text().split("|")
    assert words == ["a b", "$HOME; x"]
    assert json.loads(body)["kind"] == "fallen"


@pytest.mark.process
def test_a_program_of_the_project(tmp_path: Path) -> None:
    file = tmp_path / "page.sh"
    file.write_text("#!/bin/sh\ncat > got\n")
    file.chmod(0o700)
    send(Program(("./page.sh",)), tmp_path)
    assert json.loads((tmp_path / "got").read_text())["kind"] == "fallen"


@pytest.mark.process
@pytest.mark.parametrize(
    ("command", "said", "final"),
    [
        (["./nothing"], "the program can't be run: No such file or directory", True),
        (["no-such-program-at-all"], "the program can't be run: No such file or directory", True),
        (
            ["sh", "-c", "echo first >&2; echo no pager >&2; exit 3"],
            "the program ended with exit code 3: no pager",
            False,
        ),
    ],
)
def test_a_program_that_can_not(tmp_path: Path, command: list[str], said: str, final: bool) -> None:
    error = undelivered(Program(tuple(command)), tmp_path)
    assert (str(error), error.final) == (said, final)


@pytest.mark.process
def test_a_program_that_does_not_end_is_ended_with_its_children(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begin = ways.subprocess.Popen

    def begun(*words: Any, **options: Any) -> Any:
        """Start a program, and return once its child runs, so that the time limit starts after that."""
        process, child = begin(*words, **options), tmp_path / "child"
        until(lambda: child.exists() and child.read_text())
        return process

    monkeypatch.setattr(ways, "subprocess", SimpleNamespace(**vars(ways.subprocess) | {"Popen": begun}))
    monkeypatch.setattr(ways, "PROGRAM_TIMEOUT", 0.3)
    error = undelivered(Program(("sh", "-c", "sleep 60 & echo $! > child; sleep 60")), tmp_path)
    assert str(error) == "the program did not end within 0.3 s"
    child = int((tmp_path / "child").read_text())
    until(lambda: not _runs(child))


def _runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_nothing_in_a_text_steers_a_head_or_a_terminal() -> None:
    post = Post()
    alert = Alert("lost", "gone\r\nBcc: all@example.org\x1b[2J")
    body: dict[str, Any] = ORIGIN.body(alert)
    assert body["text"] == "NAO: gone Bcc: all@example.org [2J"
    deliver(mail(post.port), alert, ORIGIN, Path())
    until(lambda: post.mails)
    assert "\r\nBcc:" not in post.mails[0]
    post.close()
