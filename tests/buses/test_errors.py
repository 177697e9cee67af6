"""Each reason why a bus is unusable or rejects a message has its own class, so it can be caught alone."""

import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

import lumen
from lumen import (
    BadMessageError,
    BusAddressError,
    BusClosedError,
    BusError,
    BusFullError,
    BusRefusedError,
    BusUnreachableError,
    errors,
)
from lumen.bus import Bus, connect
from lumen.bus.local import LocalAddress, LocalBusClient, LocalBusServer
from lumen.language.routes import Carried, Direction, Route
from tests.exhibits import project
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, until

pytestmark = pytest.mark.usefixtures("patient_bus")


class World(NamedTuple):
    """A broker, the local bus of a folder, and a port at which no program listens."""

    broker: RabbitMQ
    served: LocalBusServer
    folder: Path
    closed_port: int


@pytest.fixture
def world(broker: RabbitMQ, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    monkeypatch.setenv("LUMEN_BUS_CREDENTIALS", str(tmp_path / "missing"))
    inside = connect("memory://")
    served = LocalBusServer(inside, tmp_path)
    with socket.socket() as unheard:  # bound here, so that no other process opens it
        unheard.bind(("127.0.0.1", 0))
        yield World(broker, served, tmp_path, int(unheard.getsockname()[1]))
    served.close()
    inside.close()


def at(world: World, user: str = "guest:guest", path: str = "", port: int = 0, scheme: str = "amqp") -> None:
    connect(f"{scheme}://{user}@127.0.0.1:{port or world.broker.port}/{path}").close()


def used(world: World, use: Callable[[Bus], object], user: str = "guest") -> None:
    bus = connect(world.broker.url_of(user), project() if user == "guest" else None)
    try:
        use(bus)
    finally:
        bus.close()


def use_after_close(world: World, url: str) -> None:
    bus = connect(url)
    bus.close()
    bus.publish("lumen.a", 1)


def use_after_the_exhibition(world: World) -> None:
    client = LocalBusClient(world.served.address)
    world.served.close()
    assert client.gone.wait(HANG)
    try:
        client.publish("lumen.a", 1)
    finally:
        client.close()


CAUSES: dict[str, tuple[type[BusError], Callable[[World], object]]] = {
    "another scheme": (BusAddressError, lambda w: connect("redis://h")),
    "no host in the address": (BusAddressError, lambda w: connect("amqp://")),
    "no file of credentials": (BusAddressError, lambda w: connect(f"amqp://127.0.0.1:{w.broker.port}/")),
    "no file of certificates": (BusAddressError, lambda w: at(w, path="?ca=missing.pem", scheme="amqps")),
    "no address of a local bus": (BusAddressError, lambda w: LocalAddress.of({})),
    "no such host": (BusUnreachableError, lambda w: connect("amqp://guest:guest@host.invalid/")),
    "port closed": (BusUnreachableError, lambda w: at(w, port=w.closed_port)),
    "no broker behind the port": (BusUnreachableError, lambda w: at(w, port=w.broker.epmd)),
    "no TLS there": (BusUnreachableError, lambda w: at(w, scheme="amqps")),
    "no exhibition on this machine": (BusUnreachableError, lambda w: LocalBusClient(LocalAddress(str(w.folder / "x")))),
    "wrong password": (BusRefusedError, lambda w: at(w, "guest:wrong")),
    "wrong name": (BusRefusedError, lambda w: at(w, "nobody:guest")),
    "no such virtual host": (BusRefusedError, lambda w: at(w, path="nowhere")),
    "no right to read": (BusRefusedError, lambda w: used(w, lambda b: b.subscribe("lumen.secret", print), "visual")),
    "wrong key of a local bus": (
        BusRefusedError,
        lambda w: LocalBusClient(LocalAddress(w.served.address.path, w.served.address.port, "wrong")),
    ),
    "closed by us": (BusClosedError, lambda w: use_after_close(w, w.broker.url)),
    "closed by us, in memory": (BusClosedError, lambda w: use_after_close(w, "memory://")),
    "the exhibition has ended": (BusClosedError, use_after_the_exhibition),
    "a body that is no JSON": (BadMessageError, lambda w: used(w, lambda b: b.publish("lumen.a", object()))),
    "a body of 2 MiB": (BadMessageError, lambda w: used(w, lambda b: b.publish("lumen.a", "x" * 2**21))),
    "a body against its schema": (
        BadMessageError,
        lambda w: used(w, lambda b: b.publish("avatar.NAO.data.sonar", {"leftSensor": "far"})),
    ),
    "a key of 300 bytes": (BadMessageError, lambda w: used(w, lambda b: b.publish("lumen." + 300 * "x", 1))),
}


@pytest.mark.parametrize("cause", CAUSES)
def test_each_cause_has_its_class(world: World, cause: str) -> None:
    expected, provoke = CAUSES[cause]
    with pytest.raises(BusError) as caught:
        provoke(world)
    assert type(caught.value) is expected
    assert "\n" not in str(caught.value)


def flood(bus: Bus, key: str) -> None:
    for n in range(20_000):
        bus.publish(key, n)


def taken(bus: Bus, key: str) -> bool:
    """Return whether the bus accepts one more message."""
    try:
        bus.publish(key, "taken")
    except BusFullError:
        return False
    return True


def test_a_broker_that_is_killed_is_unreachable_for_who_comes_and_full_for_who_sends() -> None:
    broker, key = RabbitMQ(), "lumen.errors.command"
    broker.start()
    try:
        bus = connect(broker.url)
        bus.carry({key: Route("command", key, Direction.OUT, carried=Carried.JOURNAL, must_arrive=True)})
        broker.kill()
        with pytest.raises(BusUnreachableError):
            connect(broker.url)
        with pytest.raises(BusFullError):
            flood(bus, key)
        broker.start()
        until(lambda: taken(bus, key))
        bus.close()
    finally:
        broker.stop()


def test_the_tree_of_errors_is_as_it_is_drawn() -> None:
    assert errors.__doc__
    drawn: dict[str, str] = {"LumenError": "Exception"}
    above: list[str] = []
    for line in errors.__doc__.splitlines():
        _, branch, rest = line.partition("── ")
        if branch:
            name, depth = rest.split()[0], line.index("──") // 5
            above[depth:] = [name]
            drawn[name] = above[depth - 1] if depth else "LumenError"
    real = {
        name: kind.__base__.__name__
        for name, kind in vars(errors).items()
        if isinstance(kind, type) and issubclass(kind, Exception) and kind.__base__
    }
    assert drawn == real
    assert set(real) <= set(lumen.__all__)
    assert all(kind.__doc__ for name, kind in vars(errors).items() if name in real)
