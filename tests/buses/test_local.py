"""The server of an embedded bus: who may connect, and that no client can hold up the exhibition."""

import json
import socket
import stat
import struct
import threading
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import Mock

import pytest

from lumen.bus import BusError, Message, connect
from lumen.bus.bodies import encode
from lumen.bus.local import LocalAddress, LocalBusClient, LocalBusServer
from lumen.bus.local.client import SendBuffer
from lumen.bus.local.frames import frame, framed
from lumen.bus.local.server import ClientConnection
from lumen.bus.memory import MemoryBus
from lumen.errors import BusClosedError, BusUnreachableError
from lumen.language.causes import MessageOrigin
from lumen.run.asking import send_request
from lumen.upkeep.drops import OTHERS, Drops
from tests.waiting import HANG, Collector, finished, until


class Opened:
    """An embedded bus with a server in a folder."""

    def __init__(self, folder: Path) -> None:
        self.bus = connect("memory://")
        self.server = LocalBusServer(self.bus, folder)

    def raw(self) -> socket.socket:
        wire = self.server.address.connect()
        wire.settimeout(HANG)
        return wire


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    one = Opened(tmp_path)
    yield one
    one.server.close()
    one.bus.close()


def ended(wire: socket.socket) -> bool:
    """Return whether the other side closes the connection."""
    try:
        while wire.recv(1 << 16):
            pass
    except ConnectionResetError:
        pass
    return True


@pytest.mark.once
def test_only_the_owner_can_open_it(opened: Opened) -> None:
    assert stat.S_IMODE(Path(opened.server.address.path).stat().st_mode) == 0o600


def test_who_does_not_know_the_key_stays_out(opened: Opened) -> None:
    address = opened.server.address
    with pytest.raises(BusError, match="is not the exhibition"):
        LocalBusClient(LocalAddress(address.path, address.port, "another key"))
    LocalBusClient(address).close()


@pytest.mark.parametrize(
    "said",
    [
        b"GET / HTTP/1.1\r\n\r\n",
        struct.pack(">I", 2**31) + b"x",
        struct.pack(">I", 5) + b"\xff\xff\xff\xff\xff",
        struct.pack(">I", 4) + b"null",
        struct.pack(">I", 200_000) + b"[" * 200_000,
        frame("subscribe", 1, "lumen.#"),
        frame("proof", None, 1),
        frame("proof", "0" * 64, "x"),
    ],
)
def test_who_speaks_no_sense_is_disconnected_and_nobody_else(opened: Opened, said: bytes) -> None:
    with Client(opened) as client, opened.raw() as wire:
        wire.sendall(said)
        wire.shutdown(socket.SHUT_WR)
        assert ended(wire)
        client.still_hears()


class Client:
    def __init__(self, opened: Opened) -> None:
        self.opened, self.seen = opened, Collector()

    def __enter__(self) -> "Client":
        self.bus = LocalBusClient(self.opened.server.address)
        self.bus.subscribe("lumen.alive", self.seen)
        return self

    def __exit__(self, *_: object) -> None:
        self.bus.close()

    def still_hears(self) -> None:
        self.opened.bus.publish("lumen.alive", 1)
        self.seen.wait(1)


@pytest.mark.parametrize(
    "words",
    [
        ("subscribe", "one", "lumen.#"),
        ("subscribe", 1),
        ("subscribe", 1, "x" * 300),
        ("publish", "lumen.a", "", "", {"no": "number"}, 1),
        ("publish", 1, 2, 3),
        ("dance",),
        ("proof", "again", "x"),
        ("publish", "lumen.a", "", "", 10**400, 1),
        ("publish", "lumen.a", "", "", float("nan"), 1),
        ("publish", "lumen.a", "", "", "5", 1),
        ("publish", "lumen.a", "", "", -1, 1),
        ("publish", "lumen.a", "\ud800", "", None, 1),
        ("publish", "lumen.a", "", "\ud800", None, 1),
        ("publish", "\ud800", "", "", None, 1),
        ("publish", "lumen.a", "x" * 300, "", None, 1),
        ("publish", "lumen.a", "", "", None, json.loads("[" * 900 + "]" * 900)),
        ("publish", "lumen.a", "", "", None, float("inf")),
        ("publish", "lumen.a", "", "", None, "\ud800"),
        ("publish", "lumen.a", "", "", None, {"x": 10**4000}),
        ("subscribe", 10**4000, "lumen.#"),
        ("subscribe", True, "\ud800.#"),
        ("unsubscribe", 10**400),
        ("mark", {}),
    ],
)
def test_nonsense_of_somebody_who_knows_the_key_costs_only_them(opened: Opened, words: tuple[object, ...]) -> None:
    with Client(opened) as client, Client(opened) as other:
        client.bus.subscribe("lumen.a", Collector())
        other.bus._put(frame(*words))
        client.still_hears()


def test_a_message_of_a_client_keeps_its_origin(opened: Opened) -> None:
    seen = Collector()
    opened.bus.subscribe("lumen.a", seen)
    with Client(opened) as client:
        client.bus.publish("lumen.a", 1, origin=MessageOrigin("a-7", "somebody", 5.0, "tour.c1"))
        seen.wait(1)
    (message,) = seen.messages
    assert (message.id, message.sender, message.time, message.cause) == ("a-7", "somebody", 5.0, "tour.c1")


def test_a_fault_of_ours_in_handling_a_frame_costs_one_connection(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Client(opened) as client, Client(opened) as other:
        monkeypatch.setattr(opened.bus, "publish", lambda *_, **__: 1 / 0)
        other.bus._put(frame("publish", "lumen.a", "", "", None, 1))
        assert other.bus.gone.wait(HANG)
        monkeypatch.undo()
        client.still_hears()


def test_a_question_ends_with_the_exhibition(opened: Opened) -> None:
    def answer(message: Message) -> None:
        opened.bus.publish(message.reply_to, "begun", correlation_id=message.correlation_id)

    opened.bus.subscribe("lumen.question", answer)
    with Client(opened) as client:
        answers = send_request(client.bus, "lumen.question", {}, "lumen.answers")
        assert next(answers) == "begun"
        opened.server.close()
        with pytest.raises(BusClosedError, match="the exhibition has ended"):
            next(answers)


def test_the_last_words_of_an_exhibition_arrive(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    with Client(opened) as client:
        drops, inside, going = opened.server._drops, threading.Event(), threading.Event()

        def tell() -> None:  # at the end of each turn of the server's thread
            inside.set()
            assert going.wait(HANG)

        monkeypatch.setattr(drops, "tell", tell)
        opened.bus.publish("lumen.alive", 1)
        assert inside.wait(HANG)
        opened.bus.publish("lumen.alive", "last words")
        closing = threading.Thread(target=opened.server.close)
        closing.start()
        until(lambda: opened.server._ending)
        going.set()
        finished(closing)
        client.seen.wait(2)
        assert client.seen.bodies == [1, "last words"]


@pytest.mark.once  # it opens nothing
def test_what_an_exhibition_does_not_read_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.local.client.MAX_UNSENT_BYTES", 100)
    told = list[str]()
    buffer = SendBuffer(Drops(told.append))
    for letter in (b"a", b"b", b"c"):
        buffer.put(40 * letter)
    assert buffer.take() == [40 * b"b", 40 * b"c"]
    assert told == ["messages on `other keys` are dropped: the exhibition does not read them"]


@pytest.mark.once  # it opens nothing
def test_a_buffer_is_empty_only_once_all_is_sent() -> None:
    buffer = SendBuffer(Mock())
    buffer.put(b"last words")
    assert buffer.take() == [b"last words"]
    assert not buffer.emptied(0.0)
    sender = threading.Thread(target=buffer.take)  # it has sent them
    sender.start()
    assert buffer.emptied(HANG)
    buffer.end()
    finished(sender)


def test_a_subscription_that_is_not_answered_can_be_tried_again(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Client(opened) as client:
        monkeypatch.setattr("lumen.bus.local.client.ANSWER_TIMEOUT", 0.0)
        monkeypatch.setattr(opened.server, "_subscribe", lambda *_: None)
        with pytest.raises(BusUnreachableError, match="did not answer the subscription"):
            client.bus.subscribe("lumen.late", Collector())


def test_whoever_closes_waits_for_no_thread_that_has_nothing_to_do(opened: Opened) -> None:
    client = LocalBusClient(opened.server.address)
    client.close()
    assert not any(thread.is_alive() for thread in client._threads)


def test_who_never_says_a_word_is_forgotten(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.local.server.PROOF_TIMEOUT", 0.1)
    with opened.raw() as wire:
        assert ended(wire)


def test_more_than_so_many_do_not_fit_in(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.local.server.MAX_CLIENTS", 1)
    with Client(opened) as client:
        with pytest.raises(BusError):
            LocalBusClient(opened.server.address)
        client.still_hears()


def test_who_does_not_read_slows_nobody_and_fills_no_memory(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.local.server.MAX_UNSENT_BYTES", 1_000_000)
    with Client(opened) as client:
        slow = LocalBusClient(opened.server.address)
        held = threading.Event()
        slow.subscribe("lumen.much", lambda _: held.wait(HANG))
        slow._wire.shutdown(socket.SHUT_RD)
        publishing = threading.Thread(target=lambda: much(opened), daemon=True)
        publishing.start()
        finished(publishing)
        client.still_hears()
        assert all(client.bytes < 2_000_000 for client in opened.server._clients.values())
        held.set()
        slow.close()


class Narrow:
    """A socket that accepts `room` bytes, and then no more."""

    def __init__(self, room: int) -> None:
        self.room, self.taken = room, b""

    def send(self, data: memoryview) -> int:
        if not self.room:
            raise BlockingIOError
        sent = bytes(data[: self.room])
        self.room -= len(sent)
        self.taken += sent
        return len(sent)


@pytest.mark.once  # it opens nothing
def test_of_what_waits_the_oldest_gives_way_but_not_what_is_partly_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.local.server.MAX_UNSENT_BYTES", 100)
    wire = Narrow(5)
    drops = Drops(print)
    client = ClientConnection(wire, drops)  # type: ignore[arg-type]
    for letter in (b"a", b"b", b"c", b"d", b"e"):
        client.send(40 * letter)
        client.flush()
    assert (wire.taken, client.bytes, drops.counts) == (5 * b"a", 80, {OTHERS: 3})
    wire.room = 1_000
    client.flush()
    assert wire.taken == 40 * b"a" + 40 * b"e"
    assert (client.bytes, client.sent) == (0, 0)


@pytest.mark.once  # its wire is a pair of sockets without an address
def test_what_waits_for_a_subscription_that_has_ended_is_not_handled(monkeypatch: pytest.MonkeyPatch) -> None:
    wire, exhibition = socket.socketpair()
    monkeypatch.setattr("lumen.bus.local.client._connect", lambda _: (wire, bytearray()))
    client, seen = LocalBusClient(LocalAddress()), Collector()

    def handle(message: Message) -> None:
        seen(message)
        if message.body == 1:
            with client._arriving:
                assert client._arriving.wait_for(lambda: len(client._arrived) == 2, HANG)
            undo()

    def answer() -> None:
        exhibition.recv(1 << 16)
        exhibition.sendall(frame("subscribed", 0, ""))

    answering = threading.Thread(target=answer)
    answering.start()
    undo = client.subscribe("lumen.a", handle)
    for body in (1, 2):
        exhibition.sendall(framed(["message", 0, "lumen.a", "", "", "", "", 0.0, ""], encode(body)))
    exhibition.sendall(frame("marked"))
    assert client._marked.wait(HANG)
    assert seen.bodies == [1]
    finished(answering)
    exhibition.close()
    client.close()


def much(opened: Opened) -> None:
    for _ in range(300):
        opened.bus.publish("lumen.much", {"text": "x" * 50_000})


def test_who_dies_is_forgotten(opened: Opened) -> None:
    assert isinstance(opened.bus, MemoryBus)
    before = len(opened.bus._hub.subscriptions)
    client = LocalBusClient(opened.server.address)
    client.subscribe("lumen.#", lambda _: None)
    client._wire.shutdown(socket.SHUT_RDWR)
    until(lambda: isinstance(opened.bus, MemoryBus) and len(opened.bus._hub.subscriptions) == before)
    client.close()


@pytest.mark.once
def test_when_the_exhibition_ends_its_clients_are_told(opened: Opened) -> None:
    client = LocalBusClient(opened.server.address)
    opened.server.close()
    assert client.gone.wait(HANG)
    with pytest.raises(BusError, match="the exhibition has ended"):
        client.publish("lumen.a", 1)
    client.close()
    with pytest.raises(BusError, match="no exhibition answers"):
        LocalBusClient(opened.server.address)
    assert not Path(opened.server.address.path).exists()


def test_a_run_of_a_relative_folder_is_reached_from_another_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "show").mkdir()
    monkeypatch.chdir(tmp_path)
    server = LocalBusServer(connect("memory://"), Path("show"))
    monkeypatch.chdir("show")
    server.address.connect().close()
    server.close()


def test_a_project_deep_in_folders_is_served_too(tmp_path: Path) -> None:
    deep = tmp_path / ("a" * 100) / ("b" * 100)
    deep.mkdir(parents=True)
    one = Opened(deep)
    LocalBusClient(one.server.address).close()
    one.server.close()
    assert not Path(one.server.address.path).parent.exists()


@pytest.mark.parametrize("data", [{}, {"path": "", "port": "x", "key": ""}, {"path": "", "port": [], "key": ""}])
def test_what_is_no_address_is_said(data: dict[str, object]) -> None:
    with pytest.raises(BusError, match="not an address"):
        LocalAddress.of(json.loads(json.dumps(data)))
