"""A connection to the broker leaves no socket behind, whatever the broker does."""

import math
import socket
import threading
from types import SimpleNamespace

import pika
import pytest

from lumen.features.rabbitmq import polled
from lumen.features.rabbitmq.polled import PolledConnection
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.waiting import HANG


@pytest.mark.network
@pytest.mark.parametrize("answer", [b"", b"HTTP/1.1 400 Bad Request\r\n\r\n"])
def test_an_attempt_without_a_login_closes_its_socket(answer: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    asked, closed = threading.Event(), threading.Event()
    patience = SimpleNamespace(monotonic=lambda: math.inf if asked.is_set() else 0.0)
    monkeypatch.setattr(polled, "time", patience)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            peer, _ = server.accept()
            with peer:
                peer.recv(8)
                peer.sendall(answer)
                asked.set()
                while peer.recv(8):
                    pass
            closed.set()

        threading.Thread(target=serve, daemon=True).start()
        with pytest.raises(TimeoutError):
            PolledConnection(pika.URLParameters(f"amqp://127.0.0.1:{server.getsockname()[1]}"))
        assert closed.wait(HANG)


def test_a_connection_whose_broker_is_silent_closes_its_socket(
    broker: RabbitMQ, monkeypatch: pytest.MonkeyPatch
) -> None:
    cable = Relay(broker.port)
    try:
        connection = PolledConnection(pika.URLParameters(broker.url.replace(str(broker.port), str(cable.port))))
        open_socket = connection._connection._transport._sock
        cable.cut()
        monkeypatch.setattr(polled, "BROKER_TIMEOUT", 0.1)
        connection.close()
        assert open_socket.fileno() == -1
    finally:
        cable.close()
