"""`lumen topic` and `lumen doctor`, on a broker and through the door of an embedded bus."""

import json
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.bus.validated import validated
from lumen.cli.main import main
from lumen.language.projects import Project
from lumen.run.recovery.run_directory import RunDirectory
from tests import ROOT
from tests.exhibits import project
from tests.rabbitmq import RabbitMQ
from tests.waiting import until

SONAR = "avatar.NAO.data.sonar"


class Exhibition:
    """A bus with a robot's senses, which answers its commands; with `options` the commands find it."""

    def __init__(self, bus: Bus, options: list[str]) -> None:
        self.options, self._bus, self._ending = options, bus, threading.Event()
        for key in ("avatar.NAO.command", "avatar.NAO.stop"):
            bus.subscribe(key, lambda message: bus.reply(message, "command finished"))
        bus.subscribe("lumen.deaf", lambda _: None)
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        bodies = {
            SONAR: {"rightSensor": 0.5, "leftSensor": 2.55},
            "avatar.NAO.data.joint": {"name": ["HeadYaw"], "angle": [0.1], "stiffness": [1]},
            "avatar.NAO.data.tactile": {"name": ["RightBumper"], "value": [0]},
            "lumen.note": "a\x1b[31mred",
        }
        while not self._ending.wait(0.02):
            for key, body in bodies.items():
                self._bus.publish(key, body)


@pytest.fixture(params=["embedded", pytest.param("broker", marks=pytest.mark.broker)])
def exhibition(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Exhibition]:
    monkeypatch.delenv("LUMEN_BUS", raising=False)
    shown: Project = project()
    if request.param == "broker":
        broker: RabbitMQ = request.getfixturevalue("broker")
        bus: Bus = connect(broker.url, shown)
        one = Exhibition(bus, ["--bus", broker.url])
        yield one
        one.close()
    else:
        assert main(["new", str(tmp_path / "hall")]) == 0
        monkeypatch.chdir(tmp_path / "hall")
        premises, bus = RunDirectory(tmp_path / "hall"), validated(connect("memory://"), shown)
        premises.open(bus, "memory://", shown)
        one = Exhibition(bus, [])
        yield one
        one.close()
        premises.close(forget=True)
    bus.close()


Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(exhibition: Exhibition, capsys: pytest.CaptureFixture[str]) -> Run:
    def command(*words: str) -> tuple[int, str, str]:
        capsys.readouterr()
        code = main([*words, *exhibition.options])
        said = capsys.readouterr()
        return code, said.out, said.err

    return command


@pytest.mark.network
@pytest.mark.slow
def test_echo_prints_messages_and_nothing_that_a_terminal_obeys(run: Run) -> None:
    code, out, _ = run("topic", "echo", "sonar", "--count", "2")
    assert (code, out) == (0, f'{SONAR}  {{"rightSensor": 0.5, "leftSensor": 2.55}}\n' * 2)
    assert run("topic", "echo", "lumen.note", "--count", "1")[1] == "lumen.note  a\N{REPLACEMENT CHARACTER}[31mred\n"
    found = json.loads(run("topic", "echo", SONAR, "--count", "1", "--format", "json")[1])
    assert found == {
        "key": SONAR,
        "body": {"rightSensor": 0.5, "leftSensor": 2.55},
        "reply_to": "",
        "correlation_id": "",
    }


@pytest.mark.network
@pytest.mark.slow
def test_list_hz_and_bw_measure(run: Run) -> None:
    listed: dict[str, dict[str, Any]] = {}

    def heard() -> bool:
        """Return whether half a second brought all messages; on a slow machine a later try does."""
        listed.update({row["key"]: row for row in _topics(run, "list")})
        return bool(listed[SONAR]["messages"] >= 2 and "lumen.note" in listed)

    until(heard)
    assert (listed[SONAR]["route"], listed["avatar.NAO.command"]["messages"]) == ("sonar", 0)
    assert (listed["lumen.note"]["route"], listed["lumen.note"]["origin"]) == ("", "")
    assert listed[SONAR]["origin"].startswith("lumen.yaml:")
    assert listed["lumen.visual.face.detection"]["alias"]
    assert not listed["lumen.NAO.visual.face.detection"]["alias"]

    def measured() -> bool:
        """Return whether more than one message came in the time; at most one is sent every 20 ms."""
        (sonar,) = _topics(run, "hz", "sonar")
        return sonar["hz"] is not None and 0 < sonar["hz"] < 60 and sonar["longest_gap"] > 0.0

    until(measured)
    until(lambda: _topics(run, "bw", "sonar")[0]["mean_bytes"] == len('{"rightSensor":0.5,"leftSensor":2.55}'))
    assert "no message came on `lumen.silence`" in run("topic", "hz", "lumen.silence", "--for", "50ms")[1]


def _topics(run: Run, *words: str) -> list[dict[str, Any]]:
    code, out, _ = run("topic", *words, "--for", "500ms", "--format", "json")
    assert code == 0
    return list(json.loads(out)["topics"])


@pytest.mark.network
def test_list_tells_where_each_route_comes_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("LUMEN_BUS", raising=False)
    hall = tmp_path / "hall"
    assert main(["new", str(hall), "--minimal"]) == 0
    with (hall / "lumen.yaml").open("a", encoding="utf-8") as file:
        file.write("routes:\n  lamp: {key: museum.lamp, direction: out}\n")
    shown, premises = lumen.load(hall), RunDirectory(hall)
    bus = validated(connect("memory://"), shown)
    premises.open(bus, "memory://", shown)
    listing = ["topic", "list", "--for", "1ms", "--project", str(hall)]
    capsys.readouterr()
    assert main(listing) == 0
    text = capsys.readouterr().out
    assert main([*listing, "--format", "json"]) == 0
    rows = {row["key"]: row for row in json.loads(capsys.readouterr().out)["topics"]}
    premises.close(forget=True)
    bus.close()
    heard, lamp = rows["lumen.NAO.audio.speech.recognition"], rows["museum.lamp"]
    uses = [{"place": "behaviors/hello.yaml:9", "verb": "hears"}]
    assert (heard["route"], heard["origin"], heard["uses"]) == ("heard", "comes with Lumen", uses)
    assert rows["lumen.audio.speech.recognition"]["uses"] == uses
    assert (lamp["origin"], lamp["uses"]) == ("lumen.yaml:9", [])
    assert text.splitlines()[0].split()[-1] == "origin"
    ends = {line.split()[0]: " ".join(line.split()[-6:]) for line in text.splitlines()[1:]}
    assert ends["lumen.NAO.visual.face.detection"] == "comes with Lumen: behaviors/hello.yaml:6 hears it"
    assert ends["museum.lamp"].endswith(" 0 lumen.yaml:9")


@pytest.mark.network
@pytest.mark.slow
def test_pub_sends_what_fits_its_route_and_prints_the_answer(run: Run) -> None:
    rest = '{"type": "motion", "method": "rest"}'
    assert run("topic", "pub", "command", rest, "--wait", "10s") == (0, "command finished\n", "")
    code, out, err = run("topic", "pub", "lumen.elsewhere", "a text")
    assert (code, out, err.count("\n")) == (1, "", 1)
    assert err.startswith(
        "lumen topic: no process listens to `lumen.elsewhere`: an exhibition listens to `avatar.NAO.aim`"
    )
    assert "`avatar.NAO.comand`: did you mean `avatar.NAO.command`?" in run("topic", "pub", "avatar.NAO.comand", "x")[2]
    assert "no process listens" in run("topic", "pub", "lumen.elsewhere", "a text", "--wait", "50ms")[2]
    assert run("topic", "pub", "lumen.deaf", "a text", "--wait", "50ms")[::2] == (
        1,
        "lumen topic: no answer within 0.05 s\n",
    )
    assert run("topic", "pub", "lumen.deaf", "a text") == (0, "", "")
    code, _, err = run("topic", "pub", "face", '{"x": "left", "y": 1}')
    assert (code, err.count("\n")) == (2, 1)
    assert "x: 'left' is not of type 'integer'" in err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["echo", "sonra"], "did you mean `sonar`?"),
        (["pub", "face"], "write `lumen topic pub KEY BODY`"),
        (["pub", "face", "{x: 1"], "the BODY begins like JSON but is not valid"),
        (["list", "all"], "write `lumen topic list`"),
        (["hz", "sonar", "--for", "2"], "write a number and its unit"),
    ],
)
def test_what_can_t_be_is_one_line(capsys: pytest.CaptureFixture[str], words: list[str], says: str) -> None:
    assert main(["topic", *words, "--bus", "memory://", "--project", str(ROOT)]) == 2
    err = capsys.readouterr().err
    assert says in err or "no exhibition" in err
    assert err.count("\n") == 1


@pytest.mark.network
def test_the_doctor_finds_what_is_silent(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.cli.doctor.LISTENING", 0.4)
    code, out, _ = run("doctor")
    assert code == 1
    assert "no message came on `image` in 0.4 s" in out
    assert "permissions" not in out or "this user is allowed to use all" in out
    found = json.loads(run("doctor", "--format", "json")[1])
    assert found["ok"] is False
    assert {"what", "severity", "text"} == set(found["findings"][0])


def test_the_doctor_finds_what_a_user_may_not(
    broker: RabbitMQ, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lumen.cli.doctor.LISTENING", 0.4)
    refused, out = ("`command` can't be read: ACCESS_REFUSED", "`image` can't be sent: ACCESS_REFUSED"), ""

    def told() -> bool:
        """Return whether the broker answered while the doctor listened; on a slow machine a later try does."""
        nonlocal out
        assert main(["doctor", "--bus", broker.url_of("eyes"), str(ROOT)]) == 1
        out = capsys.readouterr().out
        return all(line in out for line in refused)

    until(told)
    assert "`face` can't be sent" not in out
    assert "no process serves `command` (avatar.NAO.command)" in out


def test_who_may_not_send_is_told_so_in_one_line(broker: RabbitMQ, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["topic", "pub", "--project", str(ROOT), "--bus", broker.url_of("eyes")]
    assert main([*words, "command", '{"method": "rest"}']) == 2
    said = capsys.readouterr()
    assert "does not let this user send `avatar.NAO.command`: ACCESS_REFUSED" in said.err
    assert said.err.count("\n") == 1
    assert main([*words, "face", '{"x": 160, "y": 120}']) == 1
    assert (
        "no process listens to `lumen.NAO.visual.face.detection`: check that the exhibition is running"
        in capsys.readouterr().err
    )


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("amqp://127.0.0.1:1/", "no broker listens at 127.0.0.1:1"),
        ("amqp://guest:secret@127.0.0.1:{port}/", "refuses user `guest`"),
        ("amqp://guest:guest@127.0.0.1:{port}/nowhere", "virtual host `nowhere`"),
        ("redis://h/", "`redis://` is not a bus"),
    ],
)
@pytest.mark.parametrize("verb", [["doctor"], ["topic", "list"], ["stop"]])
def test_a_broker_that_can_t_be_used_is_one_line(
    broker: RabbitMQ, capsys: pytest.CaptureFixture[str], verb: list[str], url: str, says: str
) -> None:
    assert main([*verb, "--bus", url.format(port=broker.port)]) == 2
    said = capsys.readouterr()
    assert says in said.err
    assert (said.err.count("\n"), said.out) == (1, "")
