"""Access to a broker by password and TLS, and the check of the broker's identity."""

import socket
import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from pika import frame, spec

from lumen.bus import BusError, connect
from lumen.cli.main import main
from lumen.language.routes import Carried, Direction, Route
from tests.certificates import certify
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until

pytestmark = pytest.mark.usefixtures("patient_bus")


@pytest.fixture(scope="module")
def secure(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RabbitMQ]:
    """A broker with TLS, a certificate for 127.0.0.1, and a policy for messages without a consumer."""
    broker = RabbitMQ(certify(tmp_path_factory.mktemp("certificates"), "IP:127.0.0.1"))
    broker.start()
    yield broker
    broker.stop()


def url(broker: RabbitMQ, host: str = "127.0.0.1", ca: bool = True) -> str:
    query = f"?ca={broker.certificate}/ca.pem" if ca else ""
    return f"amqps://guest:guest@{host}:{broker.secure}/{query}"


def test_messages_come_over_tls(secure: RabbitMQ) -> None:
    bus, seen = connect(url(secure)), Collector()
    bus.subscribe("lumen.a", seen)
    bus.publish("lumen.a", "sealed")
    assert seen.wait(1) == ["sealed"]
    bus.close()


@pytest.mark.parametrize(
    ("host", "ca", "says"),
    [
        ("127.0.0.1", False, "pass the certificate of its signer, as in amqps://HOST/?ca=FILE"),
        ("localhost", True, "cannot be trusted: Hostname mismatch, certificate is not valid for 'localhost'"),
    ],
)
def test_a_broker_that_is_another_than_it_says_is_not_spoken_to(
    secure: RabbitMQ, capsys: pytest.CaptureFixture[str], host: str, ca: bool, says: str
) -> None:
    assert main(["doctor", "--bus", url(secure, host, ca)]) == 2
    said = capsys.readouterr()
    assert says in said.err
    assert said.err.count("\n") == 1


def test_no_address_turns_the_checking_off(secure: RabbitMQ) -> None:
    loose = f"{url(secure, ca=False)}?ssl_options=%7B%27cert_reqs%27%3A0%7D"
    with pytest.raises(BusError, match=r"cannot be trusted|not the address of a broker"):
        connect(loose)


def test_a_file_without_certificates_is_one_line(secure: RabbitMQ, tmp_path: Path) -> None:
    (tmp_path / "ca.pem").write_text("nothing")
    for file in (tmp_path / "ca.pem", tmp_path / "missing.pem"):
        with pytest.raises(BusError, match=r"has no certificates") as caught:
            connect(f"amqps://guest:guest@127.0.0.1:{secure.secure}/?ca={file}")
        assert "\n" not in str(caught.value)


def test_what_others_send_to_nowhere_is_told_where_a_policy_says_so(
    secure: RabbitMQ, caplog: pytest.LogCaptureFixture
) -> None:
    bus = connect(secure.url)
    bus.carry({"lumen.audio.speech": Route("heard", "lumen.audio.speech", Direction.IN, carried=Carried.TELEMETRY)})
    until(lambda: all(s.queue for s in bus._transport.consumer.subscriptions()))  # type: ignore[attr-defined]
    stranger = connect(secure.url)
    stranger.publish("lumen.audio.spech", "hello")
    until(
        lambda: "no process receives messages on `lumen.audio.spech`: did you mean `lumen.audio.speech`?" in caplog.text
    )
    stranger.close()
    bus.close()


def test_the_name_and_the_password_come_from_a_file(
    broker: RabbitMQ, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    file, plain = tmp_path / "credentials", f"amqp://{broker.place()}"
    monkeypatch.setenv("LUMEN_BUS_CREDENTIALS", str(file))
    with pytest.raises(BusError, match="cannot be read"):
        connect(plain)
    for content in ("visual", ":visual", "visual:visual\nmore"):
        file.write_text(content)
        with pytest.raises(BusError, match="must contain one line `NAME:PASSWORD`"):
            connect(plain)
    file.write_text("visual:visual\n")
    file.chmod(0o644)
    bus = connect(plain)
    assert "other users can read the password" in caplog.text
    with pytest.raises(BusError, match=r"refuses the subscription to `lumen\.secret`"):
        bus.subscribe("lumen.secret", Collector())
    bus.close()


def old_broker(listener: socket.socket, version: str) -> None:
    """Answer the handshake of AMQP 0-9-1, in which a broker names its version, for one connection after the other."""
    properties = {"product": "RabbitMQ", "version": version, "capabilities": {"publisher_confirms": True}}
    properties["capabilities"]["basic.nack"] = True  # type: ignore[index]
    answers = {
        spec.Connection.StartOk: spec.Connection.Tune(10, 131072, 60),
        spec.Connection.Open: spec.Connection.OpenOk(),
        spec.Connection.Close: spec.Connection.CloseOk(),
        spec.Channel.Open: spec.Channel.OpenOk(),
        spec.Channel.Close: spec.Channel.CloseOk(),
        spec.Basic.Qos: spec.Basic.QosOk(),
    }
    start = spec.Connection.Start(server_properties=properties, mechanisms=b"PLAIN", locales=b"en_US")

    def serve(wire: socket.socket) -> None:
        buffer = b""
        wire.recv(8)
        wire.sendall(frame.Method(0, start).marshal())
        while data := wire.recv(4096):
            buffer += data
            while (decoded := frame.decode_frame(buffer))[1] is not None:
                buffer = buffer[decoded[0] :]
                answer = answers.get(type(getattr(decoded[1], "method", None)))
                if answer:
                    wire.sendall(frame.Method(decoded[1].channel_number, answer).marshal())

    with suppress(OSError):
        while True:
            wire, _ = listener.accept()
            threading.Thread(target=serve, args=(wire,), daemon=True).start()


@pytest.mark.slow
def test_a_broker_that_is_too_old_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    listener = socket.create_server(("127.0.0.1", 0))
    threading.Thread(target=old_broker, args=(listener, "3.6.10"), daemon=True).start()
    place = f"127.0.0.1:{listener.getsockname()[1]}"
    assert main(["doctor", "--bus", f"amqp://guest:guest@{place}/"]) == 2
    said = capsys.readouterr().err
    assert said == f"lumen doctor: the broker at {place} is RabbitMQ 3.6.10, which is too old: install 3.10 or newer\n"
    listener.shutdown(socket.SHUT_RDWR)  # ends the waiting for another connection
    listener.close()
