"""`lumen alerts test`: the recipients that it reaches, and why it does not reach the others."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.cli.main import main
from tests.features.alerts.halls import files
from tests.features.alerts.servers import Post, Web
from tests.tables import for_each

Webs = Callable[..., Web]


@pytest.fixture
def folder(tmp_path: Path, web: Webs) -> Path:
    return files(tmp_path, web())


def told(folder: Path, alerts: str) -> None:
    (folder / "lumen.yaml").write_text((folder / "lumen.yaml").read_text().replace("alerts:", "#") + "\n" + alerts)


def test_tells_everybody_whatever_the_hour_and_kind(
    folder: Path, web: Webs, capsys: pytest.CaptureFixture[str]
) -> None:
    here, post = web(), Post()
    told(
        folder,
        f"alerts:\n  quiet: 00:00-23:59\n  to:\n    - {{webhook: '{here.url}', kinds: [fallen]}}\n"
        f"    - mail: {{host: 127.0.0.1, port: {post.port}, security: none, from: a@b.c, to: d@e.f}}\n"
        "    - command: [sh, -c, 'cat > got']\n",
    )
    assert main(["alerts", "test", str(folder)]) == 0
    where = here.url.removesuffix("/hook")
    assert capsys.readouterr().out.splitlines() == [
        f"ok the webhook {where}",
        "ok d@e.f by 127.0.0.1",
        "ok the command sh",
    ]
    assert here.of("test")[0]["text"] == "TINY: this is a test: you will receive this robot's alerts"
    assert json.loads((folder / "got").read_text())["kind"] == "test"
    assert len(post.mails) == 1
    post.close()


def test_says_who_is_not_reached_and_why(folder: Path, web: Webs, capsys: pytest.CaptureFixture[str]) -> None:
    told(folder, f"alerts: {{to: [{{webhook: '{web(404).url}'}}, {{command: [./nothing]}}]}}\n")
    assert main(["alerts", "test", str(folder), "--format", "json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert (found["ok"], [one["reason"] for one in found["told"]]) == (
        False,
        ["the server answers 404 Not Found", "the program can't be run: No such file or directory"],
    )


def test_nobody_is_to_be_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told(folder, "")
    assert main(["alerts", "test", str(folder)]) == 2
    assert "no alert recipients: list them in" in capsys.readouterr().err


@for_each(
    ("broken", "place"),
    [
        (b"alerts: [", "lumen.yaml:1:9: error [yaml-syntax]"),
        (b"\xff\xfe", "lumen.yaml:1:1: error [not-utf8]"),
        (b"alerts: {to: [{command: [echo]}, {webhok: 'http://127.0.0.1'}]}", "lumen.yaml:1:35: error [unknown-key]"),
    ],
)
def test_a_faulty_lumen_yaml_is_reported_and_nothing_is_sent(
    folder: Path, capsys: pytest.CaptureFixture[str], broken: bytes, place: str
) -> None:
    (folder / "lumen.yaml").write_bytes(broken + b"\n")
    assert main(["alerts", "test", str(folder)]) == 1
    told = capsys.readouterr()
    assert (told.out, place in told.err) == ("", True), told.err
