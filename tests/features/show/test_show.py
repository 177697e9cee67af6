"""Routes to OSC and DMX and back, with real clients of each on loopback, and what all links share."""

import socket
from collections.abc import Callable, Iterator
from threading import Thread
from typing import Any

import pytest
import sacn
from pythonosc.dispatcher import Dispatcher
from pythonosc.osc_server import ThreadingOSCUDPServer
from pythonosc.udp_client import SimpleUDPClient

from lumen.features.show import dmx, health
from lumen.features.show.osc import OscDevice
from lumen.features.show.settings import AddressMapping, DmxLink, OscLink
from lumen.language.projects import Project
from lumen.project.message_fields import message_fields
from lumen.upkeep.drops import MAX_KEYS, TELL_PERIOD, Drops
from tests.features.show.linked import BUTTON, LAMP, MESSAGES, Make, added
from tests.waiting import HANG, Collector, until


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


@pytest.fixture
def desk() -> Iterator[tuple[int, list[Any]]]:
    """The port of a sound desk, and the messages that it has received."""
    came, dispatcher = list[Any](), Dispatcher()
    dispatcher.set_default_handler(lambda address, *arguments: came.append((address, arguments)))
    server = ThreadingOSCUDPServer(("127.0.0.1", 0), dispatcher)
    thread = Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    yield int(server.server_address[1]), came
    server.shutdown()
    server.server_close()


def test_a_sound_desk_by_osc(desk: tuple[int, list[Any]], museum: Callable[..., Project], stand: Make) -> None:
    (port, came), ours = desk, free_port()
    routes = {
        "lamp": AddressMapping("/light"),
        "mood": AddressMapping("/mood", ("name",)),
        "button": AddressMapping("/b"),
        "fader": AddressMapping("/ch/1", ("level", "name")),
    }
    here = stand(museum(osc=OscLink("127.0.0.1", port, ours, routes)))
    pressed, moved = here.listen(BUTTON), here.listen("museum.fader")
    module, sender = added(here), SimpleUDPClient("127.0.0.1", ours)
    here.bus.publish(LAMP, {"level": 1, "on": True})
    here.bus.publish("museum.mood", {"name": "früh"})
    until(lambda: len(came) == 2)
    assert sorted(came) == [("/light", (1.0, True)), ("/mood", ("früh",))]
    assert isinstance(dict(came)["/light"][0], float)
    until(lambda: _moved(sender, moved))
    sender.send_message("/b", 3.0)
    assert pressed.wait(1) == [{"number": 3}]
    assert moved.bodies[0] == {"level": 0.5, "name": "left"}
    here.bus.publish(LAMP, {"level": 1})
    before = module.refused
    for arguments in ([], [1, 2], ["x"], [12]):
        sender.send_message("/b", arguments)
    sender.send_message("/nobody", 1)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.bind(("127.0.0.2", 0))
        stranger.sendto(b"/b\0\0,i\0\0\0\0\0\1", ("127.0.0.1", ours))
    for garbage in (
        b"",
        b"\0",
        b"#bundle\0" + b"\xff" * 12,
        b"/b\0\0,i\0\0",
        b"#bundle\0" + bytes(8) + b"\x7f\xff\xff\xff",
    ):
        sender._sock.sendto(garbage, ("127.0.0.1", ours))
    until(lambda: module.refused >= before + 6 + 4)
    sender.send_message("/b", 4)
    assert pressed.wait(2)[1] == {"number": 4}
    assert "messages on `lamp (OSC)` are dropped: the body has no `on`" in here.told
    assert any("127.0.0.2 is not 127.0.0.1" in line or "no route has the address" in line for line in here.told)


def test_an_address_without_a_route_loses_no_other_message_of_its_bundle() -> None:
    link = OscLink("127.0.0.1", 9000, 9001, {"button": AddressMapping("/b")})
    told, taken = list[str](), list[Any]()

    def deliver(route: str, source: str, body: Callable[[], Any]) -> None:
        taken.append((route, source, body()))

    fields = {"button": [*message_fields(MESSAGES["button"]).values()]}
    well = health.LinkHealth("the desk", told.append, lambda: None)
    device = OscDevice(link, fields, ["button"], deliver, Drops(told.append), well)
    parts = [b"/nobody\0,i\0\0\0\0\0\1", b"/b\0\0,i\0\0\0\0\0\3"]
    device._take(b"#bundle\0" + bytes(7) + b"\1" + b"".join(len(part).to_bytes(4) + part for part in parts))
    assert taken == [("button", "/b (OSC)", {"number": 3})]
    assert told == ["messages on `the port 9001 (OSC)` are dropped: no route has the address /nobody"]


def _moved(sender: SimpleUDPClient, moved: Collector) -> bool:
    """Return True if a move of the desk arrived; if not, move it once more, since the port may open late."""
    if not moved.messages:
        sender.send_message("/ch/1", [0.5, "left"])
    return bool(moved.messages)


@pytest.mark.network
def test_a_lamp_by_dmx(museum: Callable[..., Project], stand: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dmx, "PORT", free_port())
    link = DmxLink(7, "127.0.0.1", {"lamp": {"level": 1, "on": 512}})
    came, ended = list[Any](), list[str]()
    receiver = sacn.sACNreceiver(bind_address="127.0.0.1", bind_port=dmx.PORT)
    receiver.register_listener("universe", came.append, universe=7)
    receiver.register_listener("availability", lambda universe, changed: ended.append(changed))
    receiver.start()
    try:
        here = stand(museum(dmx=link))
        module = added(here)
        here.bus.publish(LAMP, {"level": 0.5, "on": True})
        until(lambda: came)
        assert (came[-1].dmxData[0], came[-1].dmxData[1], came[-1].dmxData[511]) == (128, 0, 255)
        assert (came[-1].sourceName, came[-1].universe, came[-1].priority) == ("Lumen NAO", 7, 100)
        here.bus.publish(LAMP, {"level": 7 / 9})
        until(lambda: came[-1].dmxData[0] == 198)
        assert came[-1].dmxData[511] == 255, "what a body does not say stays"
        until(lambda: ended == ["available"])
        module.close()
        until(lambda: ended == ["available", *["timeout"] * 3])
    finally:
        receiver.stop()
    assert here.told == []


def test_dmx_is_kept_alive_and_darkens_nothing_before_its_first_message(
    museum: Callable[..., Project], stand: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        monkeypatch.setattr(dmx, "PORT", receiver.getsockname()[1])
        receiver.setblocking(False)
        here = stand(museum(dmx=DmxLink(1, "127.0.0.1", {"lamp": {"level": 1}})))
        added(here)
        here.settle()
        with pytest.raises(BlockingIOError):
            receiver.recv(1000)
        here.bus.publish(LAMP, {"level": 1})
        receiver.settimeout(HANG)
        packets = [receiver.recv(1000) for _ in range(3)]
    assert [len(packet) for packet in packets] == [638] * 3
    assert {packet[:16] for packet in packets} == {b"\x00\x10\x00\x00ASC-E1.17\x00\x00\x00"}  # E1.31, 5.1 to 5.3
    assert [packet[111] for packet in packets] == [0, 1, 2]
    assert {packet[126] for packet in packets} == {255}


@pytest.mark.network
def test_a_saved_file_connects_anew(desk: tuple[int, list[Any]], museum: Callable[..., Project], stand: Make) -> None:
    port, came = desk
    here = stand(museum(osc=OscLink("127.0.0.1", port, routes={"mood": AddressMapping("/before")})))
    module = added(here)
    here.bus.publish("museum.mood", {"name": "x"})
    until(lambda: came == [("/before", ("x",))])
    module.use(museum(osc=OscLink("127.0.0.1", port, routes={"mood": AddressMapping("/after")})))
    here.bus.publish("museum.mood", {"name": "y"})
    until(lambda: came[1:] == [("/after", ("y",))])
    module.use(museum())
    here.bus.publish("museum.mood", {"name": "z"})
    here.settle()
    assert len(came) == 2


def test_a_device_that_has_no_name_is_told_once(museum: Callable[..., Project], stand: Make) -> None:
    routes = {"mood": AddressMapping("/x")}
    here = stand(
        museum(osc=OscLink("nobody.invalid", 9000, routes=routes), dmx=DmxLink(1, "..", {"lamp": {"level": 1}}))
    )
    added(here)
    for _ in range(5):
        here.bus.publish("museum.mood", {"name": "x"})
        here.bus.publish(LAMP, {"level": 1})
    here.settle()
    assert (
        len([line for line in here.told if line.startswith("the OSC device nobody.invalid:9000 cannot be reached")])
        == 1
    )
    assert len([line for line in here.told if line.startswith("DMX universe 1 cannot be sent to")]) == 1


def test_a_flood_is_a_line_and_then_a_count() -> None:
    told, now = list[str](), [0.0]
    found = Drops(told.append, clock=lambda: now[0])
    for _ in range(500):
        found.add("hall/button (MQTT)", "it is not JSON")
        found.tell()
    now[0] = TELL_PERIOD
    found.tell()
    assert told == [
        "messages on `hall/button (MQTT)` are dropped: it is not JSON",
        "more messages on `hall/button (MQTT)` were dropped (499 in 10 s): it is not JSON",
    ]
    for i in range(2 * MAX_KEYS):
        found.add(f"topic {i}", "it is no JSON")
    found.tell(all=True)
    assert len(told) == 2 + MAX_KEYS + 1
    assert sum(found.counts.values()) == 500 + 2 * MAX_KEYS
