"""Broker addresses, brokers and messages from other systems' bug reports: one line names the fault and the correction.

Each case is reduced from a public report.
"""

import base64
import gzip
import re
import socket
import zlib
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pika
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen import load
from lumen.bus import connect
from lumen.bus.bodies import JSON, TEXT, decode
from lumen.bus.checking import SchemaCheck
from lumen.bus.validated import validated
from lumen.cli.main import main
from lumen.errors import BusAddressError, BusUnreachableError
from lumen.features.rabbitmq.broker import BrokerAddress, shortage
from lumen.features.rabbitmq.probe import BrokerProbe
from lumen.language.addresses import public
from lumen.lint import check_files
from lumen.ports import BlockableBus, UsesBroker
from lumen.project.files import read_files
from lumen.run import node
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import run_guarded
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.tables import for_each
from tests.waiting import UNLIMITED, Collector, until

MINIMAL = ROOT / "examples/minimal"


def refusal(url: str) -> str:
    with pytest.raises(BusAddressError) as caught:
        connect(url)
    return str(caught.value)


@for_each(
    ("password", "said"),
    [
        ("QQ/QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %2F for `/`"),
        ("QQ#QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %23 for `#`"),
        ("QQ?QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %3F for `?`"),
        ("17/QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %2F for `/`"),
        ("17#QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %23 for `#`"),
        ("QQ?a=QQ", "`amqp://h/` is not the address of a broker (in the user name and password, write %3F for `?`"),
        (
            "Q[Q]",
            "`amqp://h/` is not the address of a broker (in the user name and password, write %5B for `[`, %5D for `]`",
        ),
        ("QQ/Q#Q?", "(in the user name and password, write %2F for `/`, %3F for `?`, %23 for `#`"),
        ("QQ@Q/Q", "`amqp://h/` is not the address of a broker (in the user name and password, write %2F for `/`"),
    ],
)
def test_a_password_with_signs_of_an_address_is_not_shown(password: str, said: str) -> None:
    told = refusal(f"amqp://u:{password}@h/")
    assert said in told
    assert "Q" not in told
    assert "17" not in told


def shown(url: str) -> str:
    """Return the printed form of a valid address, or the error for an invalid one."""
    try:
        return str(BrokerAddress(url))
    except BusAddressError as error:
        return str(error)


PATHS = ["", "/", "/museum", ":5672/?heartbeat=5"]


@given(password=st.text("Q1/#?@[]:%&=;℀ ", min_size=1), path=st.sampled_from(PATHS))
def test_no_part_of_a_password_is_shown(password: str, path: str) -> None:
    url = f"amqp://u:Q{password}Q@h{path}"
    assert "Q" not in public(url) + shown(url)


@for_each(
    ("url", "said"),
    [
        (
            "amqp://guest:secret",
            "`amqp://guest:…` is not the address of a broker (its port is not a number from 0 to 65535)",
        ),
        ("amqp://guest:secret/museum", "`amqp://guest:…` is not the address of a broker"),
        ("amqp://u:secret@h:port/", "`amqp://h:…` is not the address of a broker (its port is not a number"),
        ("amqp://u:secret@h:70000/", "its port is not a number from 0 to 65535"),
        ("amqp://u:secret@/", "it has no host"),
        ("amqp://u:secret℀@h/", "it contains a character that is not allowed in an address"),
    ],
)
def test_another_error_in_an_address_does_not_show_the_password(url: str, said: str) -> None:
    told = refusal(url)
    assert said in told
    assert "secret" not in told


@for_each(
    ("path", "said"),
    [
        (
            "/museum/hall",
            "a virtual host is one segment, with %2F for each slash: write /museum%2Fhall instead of /museum/hall",
        ),
        ("//museum", "with %2F for each slash: write /%2Fmuseum (or /museum) instead of //museum"),
        ("//", "write /%2F instead of //"),
        ("/a/b/", "write /a%2Fb%2F instead of /a/b/"),
        ("/museum#hall", "write %23 for `#`"),
    ],
)
def test_a_virtual_host_of_several_segments_is_refused(path: str, said: str) -> None:
    assert said in refusal(f"amqp://h{path}")


@for_each(
    ("path", "vhost"),
    [
        ("", "/"), ("/", "/"), ("/museum", "museum"), ("/museum/", "museum"), ("/%2F", "/"), ("/%2Fmuseum", "/museum"),
        ("/museum%2Fhall", "museum/hall"), ("/a%40b", "a@b"), ("/a%23b?heartbeat=5", "a#b"),
    ],
)  # fmt: skip
def test_a_virtual_host_is_the_one_that_was_written(path: str, vhost: str) -> None:
    address = BrokerAddress(f"amqp://u%2F:p%2F%23%3F%40@h{path}")
    assert (address.vhost, address.user, address.parameters.credentials.password) == (vhost, "u/", "p/#?@")


@for_each("password", ["secret", "se/cret", "se#cret", "se?cret", "12/cret", "12#cret", "s[cret", "se@cret"])
@for_each("file", ["lumen.yaml", "fleet.yaml", "alerts"])
def test_a_password_in_a_file_is_found_with_any_characters(file: str, password: str) -> None:
    files = read_files(MINIMAL)
    if file == "fleet.yaml":
        files[file] = f"houses: {{a: {{broker: 'amqps://u:{password}@h/', robots: [nao]}}}}\n".encode()
    elif file == "alerts":
        if password.startswith("12"):
            return  # `https://u:12/cret@h/` is an address on the web, of the host `u`
        files["lumen.yaml"] += f"alerts: {{to: [{{webhook: 'https://u:{password}@h/'}}]}}\n".encode()
    else:
        files[file] += f"bus: 'amqp://u:{password}@h/'\n".encode()
    found = [d for d in check_files(MINIMAL, files)[1] if d.code == "password-in-file"]
    assert len(found) == 1
    assert "cret" not in found[0].message + found[0].hint


def test_the_hint_explains_how_to_write_it_elsewhere() -> None:
    files = read_files(MINIMAL)
    files["lumen.yaml"] += b"bus: 'amqp://u:pa/s#s@h/'\n"
    [found] = [d for d in check_files(MINIMAL, files)[1] if d.code == "password-in-file"]
    assert found.hint.endswith("; in LUMEN_BUS write %2F for `/`, %23 for `#`")


@pytest.mark.parametrize("words", [["doctor"], ["topic", "list"], ["status"], ["run", "--robot", "recording"]])
@pytest.mark.process
def test_each_command_keeps_the_password(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("LUMEN_BUS", "amqp://u:12/pa#ss@h/")
    monkeypatch.chdir(copied_project(MINIMAL, tmp_path / "minimal"))
    assert main(words) != 0
    printed = capsys.readouterr()
    assert "write %2F for `/`, %23 for `#`" in printed.err
    assert printed.err.count("\n") == 1
    assert "pa#" not in printed.out + printed.err


@pytest.fixture
def silent_port() -> Iterator[int]:
    """A loopback port that accepts connections but sends nothing, like a stopped broker or the wrong program."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield int(listener.getsockname()[1])


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten the waits for a broker that never answers."""
    monkeypatch.setattr("lumen.features.rabbitmq.polled.BROKER_TIMEOUT", 0.2)
    monkeypatch.setattr("lumen.features.rabbitmq.broker.SOCKET_TIMEOUT", 0.2)
    monkeypatch.setattr("lumen.features.rabbitmq.broker.BROKER_TIMEOUT", 0.2)
    monkeypatch.setattr("lumen.cli.doctor.LISTENING", 0.2)


ASKING = ["doctor", "topic list", "topic echo heard", "topic pub lumen.a 1", "status", "stop"]


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("words", ASKING)
def test_a_port_that_is_silent_is_one_line(
    words: str, silent_port: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(MINIMAL)
    assert main([*words.split(), "--bus", f"amqp://127.0.0.1:{silent_port}/"]) == 2
    said = capsys.readouterr()
    assert (
        f"the broker at 127.0.0.1:{silent_port} does not answer: check the host, the port and the network" in said.err
    )
    assert (said.err.count("\n"), said.out) == (1, "")


@pytest.mark.parametrize("ask", [lambda p: p.writing("lumen.a"), lambda p: p.reading("lumen.a")], ids=["write", "read"])
def test_a_broker_that_hangs_after_the_login_is_reported(
    ask: Callable[[BrokerProbe], str], broker: RabbitMQ, monkeypatch: pytest.MonkeyPatch
) -> None:
    relay = Relay(broker.port)
    with closing(relay), closing(BrokerProbe(f"amqp://guest:guest@{broker.place(relay.port)}")) as probe:
        assert ask(probe) == ""
        relay.cut()
        monkeypatch.setattr("lumen.features.rabbitmq.polled.BROKER_TIMEOUT", 0.2)
        with pytest.raises(BusUnreachableError, match="does not answer"):
            ask(probe)


BODY = '{"x": 160, "y": 120}'


@for_each(
    ("data", "content_type", "content_encoding", "reason"),
    [
        (b"\xef\xbb\xbf" + BODY.encode(), JSON, "", "it begins with a byte order mark (BOM), which JSON does not have"),
        (BODY.encode("utf-16"), JSON, "", "it is UTF-16: send UTF-8"),
        (BODY.encode("utf-16-le"), JSON, "utf-16", "it is UTF-16: send UTF-8"),
        (BODY.encode("utf-16-be"), JSON, "", "it is UTF-16: send UTF-8"),
        ("hello".encode("utf-16-le"), TEXT, "", "it is UTF-16: send UTF-8"),
        (BODY.encode("utf-32"), JSON, "", "it is UTF-32: send UTF-8"),
        (b"\x00\x01\x02\x03", JSON, "", "it is not JSON"),
        (gzip.compress(BODY.encode()), JSON, "gzip", "it is compressed with gzip: send it as it is"),
        (gzip.compress(BODY.encode()), "", "", "it is compressed with gzip: send it as it is"),
        (gzip.compress(b"hello"), TEXT, "gzip", "it is compressed with gzip: send it as it is"),
        (zlib.compress(BODY.encode()), JSON, "deflate", "its content encoding is `deflate`: send plain UTF-8"),
        (base64.b64encode(BODY.encode()), JSON, "base64", "its content encoding is `base64`: send plain UTF-8"),
        ('{"x": "é"}'.encode("latin-1"), JSON, "iso-8859-1", "its content encoding is `iso-8859-1`: send plain UTF-8"),
        ('{"x": "é"}'.encode("latin-1"), JSON, "", "it is not UTF-8 (invalid continuation byte at byte 7)"),
        (b"{'x': 1}", JSON, "utf-8", "it is not JSON (Expecting property name"),
    ],
)
def test_a_body_other_than_plain_utf_8_is_refused_with_the_reason(
    data: bytes, content_type: str, content_encoding: str, reason: str
) -> None:
    with pytest.raises(ValueError, match=re.escape(reason)):
        decode(data, content_type or JSON, content_encoding)


@for_each("encoding", ["", "utf-8", "UTF-8", "identity", "binary", "gzip"])
def test_a_plain_body_is_read_with_any_declared_encoding(encoding: str) -> None:
    assert decode(BODY.encode(), JSON, encoding) == {"x": 160, "y": 120}


@for_each(
    ("body", "says"),
    [
        (
            BODY,
            (
                "it is a string that contains JSON: encode it once, and send it with the content type "
                "application/json, not text/plain"
            ),
        ),
        ("[1, 2]", "it is a string that contains JSON"),
        ("hello", "'hello' is not of type 'object'"),
        ("{hello}", "'{hello}' is not of type 'object'"),
        ({"x": "left"}, "x: 'left' is not of type"),
    ],
)
def test_json_sent_as_a_text_is_reported(body: object, says: str) -> None:
    schema = {"type": "object", "properties": {"x": {"type": "number"}}}
    assert SchemaCheck(schema)(body).startswith(says)


def test_a_refusal_names_the_content_type_and_the_encoding(broker: RabbitMQ) -> None:
    shipped = load(MINIMAL)
    key = shipped.routes["face"].key_for(shipped.robot)
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    with closing(connection), closing(connect(broker.url, shipped)) as bus:
        bus.subscribe(key, lambda message: None)
        channel = connection.channel()
        mine = channel.queue_declare("", exclusive=True).method.queue
        answers = []
        for data, kind, encoding in (
            (BODY.encode(), TEXT, ""),
            (b"\xef\xbb\xbf" + BODY.encode(), JSON, ""),
            (gzip.compress(b"{}"), JSON, "gzip"),
        ):
            said = pika.BasicProperties(reply_to=mine, content_type=kind, content_encoding=encoding or None)
            channel.basic_publish("amq.topic", key, data, said)
            answers.append(next(channel.consume(mine, auto_ack=True))[2].decode())
    for answer, word in zip(answers, ("text/plain", "BOM", "gzip"), strict=True):
        assert answer.startswith("message refused: ")
        assert word in answer


Declare = Callable[[Any], object]

OTHERWISE: dict[str, tuple[Declare, str]] = {
    "an exchange of another type": (
        lambda c: c.exchange_declare("lumen.dead", "topic", durable=True),
        "the exchange `lumen.dead` was declared with other arguments (its `type` is 'topic', not 'fanout')",
    ),
    "an exchange that is not durable": (
        lambda c: c.exchange_declare("lumen.nowhere", "fanout"),
        "the exchange `lumen.nowhere` was declared with other arguments (its `durable` is 'false', not 'true')",
    ),
    "a queue with other limits": (
        lambda c: c.queue_declare("lumen.dead", durable=True, arguments={"x-max-length": 5}),
        "the queue `lumen.dead` was declared with other arguments (its `x-m",
    ),
    "a queue of another type": (
        lambda c: c.queue_declare("lumen.dead", durable=True, arguments={"x-queue-type": "quorum"}),
        "the queue `lumen.dead` was declared with other arguments (its `x-",
    ),
}


@pytest.mark.parametrize("name", OTHERWISE)
def test_dead_letters_declared_with_other_settings_are_reported(
    name: str,
    broker: RabbitMQ,
    caplog: pytest.LogCaptureFixture,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    declare, said = OTHERWISE[name]
    monkeypatch.setattr("lumen.cli.doctor.LISTENING", 0.2)
    monkeypatch.chdir(MINIMAL)
    with closing(pika.BlockingConnection(pika.URLParameters(broker.url))) as connection:
        channel = connection.channel()
        _without_side_queues(channel)
        declare(channel)
        connect(broker.url).close()
        told = [record.getMessage() for record in caplog.records if "other arguments" in record.getMessage()]
        assert len(told) == 1
        assert said in told[0]
        assert "its messages are lost: run `rabbitmq" in told[0]
        assert main(["doctor", "--bus", broker.url]) == 1
        assert f"!! dead letters: {said}" in capsys.readouterr().out
        _without_side_queues(channel)
        main(["doctor", "--bus", broker.url])
        kept = "ok dead letters: unusable and undeliverable messages are kept in lumen.dead and lumen.nowhere"
        assert kept in capsys.readouterr().out


def _without_side_queues(channel: Any) -> None:
    for name in ("lumen.dead", "lumen.nowhere"):
        channel.queue_delete(name)
        channel.exchange_delete(name)


def rabbitmqctl(broker: RabbitMQ, words: str) -> None:
    assert run_guarded(["sh", "-c", f"{broker.ctl} {words}"], capture_output=True).returncode == 0


def takes_nothing(broker: RabbitMQ) -> bool:
    with closing(BrokerProbe(broker.url)) as probe:
        return probe.taking() != ""


ALARM, NO_ALARM = "set_vm_memory_high_watermark 0", "set_vm_memory_high_watermark 0.6"


@pytest.fixture(scope="module")
def own_broker() -> Iterator[RabbitMQ]:
    """A broker for this module only, so that its alarm affects no other test."""
    own = RabbitMQ()
    own.start()
    try:
        yield own
    finally:
        own.stop()


@pytest.fixture
def short(own_broker: RabbitMQ) -> Iterator[RabbitMQ]:
    """A broker that is short of memory."""
    rabbitmqctl(own_broker, ALARM)
    until(lambda: takes_nothing(own_broker))
    yield own_broker
    rabbitmqctl(own_broker, NO_ALARM)


def test_a_broker_that_is_short_of_memory_is_reported_and_not_lost(
    short: RabbitMQ, caplog: pytest.LogCaptureFixture
) -> None:
    bus, came = validated(connect(short.url), load(MINIMAL)), Collector()
    with closing(bus):
        bus.subscribe("lumen.a", came)
        bus.publish("lumen.a", 1)
        blockable, broker = bus.ability(BlockableBus), bus.ability(UsesBroker)
        assert blockable
        assert broker
        until(lambda: blockable.blocked == "memory")
        assert not broker.away
        bus.publish("lumen.a", 2)
        bus.publish("lumen.a", 3, ttl=0.01)
        rabbitmqctl(short, NO_ALARM)
        until(lambda: not blockable.blocked)
        assert came.wait(2) == [1, 2]
    told = [record.getMessage() for record in caplog.records]
    place = f"127.0.0.1:{short.port}"
    assert [line[:66] for line in told if place in line] == [
        f"the broker at {place} is short of memory and accepts no messages until"[:66],
        f"the broker at {place} accepts messages again",
    ]


def test_each_command_names_what_the_broker_is_short_of(
    short: RabbitMQ, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(MINIMAL)
    reason = "is short of memory and accepts no messages until it has enough: run `rabbitmqctl status`"
    assert main(["topic", "pub", "lumen.a", "1", "--bus", short.url]) == 2
    said = capsys.readouterr().err
    assert said.startswith("lumen topic: the broker at")
    assert reason in said
    assert said.count("\n") == 1
    assert main(["doctor", "--bus", short.url]) == 1
    assert f"!! broker: the broker at 127.0.0.1:{short.port} {reason}" in capsys.readouterr().out


def test_no_second_brain_starts_while_the_first_is_unreachable(
    short: RabbitMQ, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(copied_project(MINIMAL, tmp_path / "minimal"))
    monkeypatch.setattr(node, "CLAIM_DURATION", UNLIMITED)
    assert main(["run", "--only", "brain", "--bus", short.url]) == 2
    assert "can't check whether another process is the brain of NAO" in capsys.readouterr().err


@for_each(
    ("reason", "said"),
    [
        ("low on memory", "memory"),
        ("low on disk", "disk"),
        ("low on memory & disk", "memory and disk"),
        ("low on file descriptors", "resources"),
    ],
)
def test_the_reason_of_a_broker_is_reworded(reason: str, said: str) -> None:
    assert shortage(reason) == said
