"""Routes to MQTT, OSC and DMX and back, with real clients of each on loopback."""

import json
import socket
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from threading import Thread
from typing import Any

import pytest
import sacn
from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion
from pythonosc.dispatcher import Dispatcher
from pythonosc.osc_server import ThreadingOSCUDPServer
from pythonosc.udp_client import SimpleUDPClient

from lumen.bus import connect
from lumen.features.show import health, mqtt
from lumen.features.show.module import ShowControl
from lumen.features.show.osc import OscDevice
from lumen.features.show.settings import AddressMapping, DmxLink, MqttLink, OscLink, Show, TopicMapping
from lumen.language.projects import Project
from lumen.language.routes import Carried, Direction, Route
from lumen.project.message_fields import message_fields
from lumen.upkeep.drops import MAX_KEYS, TELL_PERIOD, Drops
from tests.features.conftest import Stand
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until

Make = Callable[..., Stand]
LAMP, BUTTON = "museum.lamp.set", "museum.button"
ROUTES = {
    "lamp": Route("lamp", LAMP, Direction.OUT, schema="lamp", carried=Carried.COMMAND, ttl=2.0),
    "mood": Route("mood", "museum.mood", Direction.OUT, schema="mood"),
    "button": Route("button", BUTTON, Direction.IN, schema="button", event="button", most=5.0),
    "fader": Route("fader", "museum.fader", Direction.IN, schema="fader"),
}
FULL = {"type": "number", "minimum": 0, "maximum": 1}
MESSAGES: Mapping[str, Any] = {
    "lamp": {"type": "object", "properties": {"level": FULL, "on": {"type": "boolean"}}},
    "mood": {"type": "object", "properties": {"name": {"type": "string"}}},
    "button": {"type": "object", "properties": {"number": {"type": "integer", "maximum": 9}}, "required": ["number"]},
    "fader": {"type": "object", "properties": {"name": {"type": "string"}, "level": FULL}},
}


@pytest.fixture(scope="module")
def speaker() -> Iterator[RabbitMQ]:
    """A RabbitMQ that speaks MQTT."""
    rabbitmq = RabbitMQ(speaks_mqtt=True)
    rabbitmq.start()
    yield rabbitmq
    rabbitmq.stop()


@pytest.fixture(autouse=True)
def _password(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "mqtt"
    file.write_text("guest:guest\n")
    monkeypatch.setenv(mqtt.CREDENTIALS_VARIABLE, str(file))


class Device:
    """A lamp or a button: a client of MQTT that keeps the messages that it receives."""

    def __init__(self, port: int, *topics: str, user: str = "guest") -> None:
        self.came: list[tuple[str, bytes, bool]] = []
        self.client, self._ready = Client(CallbackAPIVersion.VERSION2), 0
        self.client.username_pw_set(user, user)
        self.client.on_message = self._take
        self.client.on_subscribe = self._subscribed
        self.client.connect("127.0.0.1", port)
        for topic in topics:
            self.client.subscribe(topic, 1)
        self.client.loop_start()
        until(lambda: self._ready == len(topics) and self.client.is_connected())

    def _subscribed(self, *_: Any) -> None:
        self._ready += 1

    def _take(self, client: Any, data: Any, message: MQTTMessage) -> None:
        self.came.append((message.topic, bytes(message.payload), message.retain))

    def wait(self, count: int) -> list[tuple[str, bytes, bool]]:
        until(lambda: len(self.came) >= count)
        return self.came

    def send(self, topic: str, payload: bytes | str, *, retain: bool = False) -> None:
        self.client.publish(topic, payload, 1, retain).wait_for_publish(HANG)

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()


@pytest.fixture
def device(speaker: RabbitMQ) -> Iterator[Callable[..., Device]]:
    devices: list[Device] = []

    def make(*topics: str, user: str = "guest") -> Device:
        devices.append(Device(speaker.mqtt, *topics, user=user))
        return devices[-1]

    yield make
    for one in devices:
        one.close()


@pytest.fixture
def museum(project: Project) -> Callable[..., Project]:
    def make(**links: Any) -> Project:
        messages = {**project.messages, **MESSAGES}
        linked = project.with_section("modules.show", Show(**links))
        return replace(linked, routes={**project.routes, **ROUTES}, messages=messages)

    return make


def added(here: Stand) -> ShowControl:
    module = ShowControl(here.project, here.bus, here.told.append)
    here.add(module)
    return module


@pytest.mark.broker
def test_rabbitmq_carries_a_route_to_mqtt_and_back_without_a_module(
    speaker: RabbitMQ, device: Callable[..., Device], museum: Callable[..., Project]
) -> None:
    lamp, pressed = device("museum/lamp/set", user="lamp"), Collector()
    bus = connect(speaker.url, museum())
    bus.subscribe(BUTTON, pressed)
    bus.publish(LAMP, {"level": 0.5})
    [(topic, payload, _)] = lamp.wait(1)
    assert (topic, json.loads(payload)) == ("museum/lamp/set", {"level": 0.5})
    lamp.send("museum/button", '{"number": 3}')
    assert pressed.wait(1) == [{"number": 3}]
    bus.close()


@pytest.mark.broker
def test_a_lamp_and_a_button_by_mqtt(
    speaker: RabbitMQ, device: Callable[..., Device], museum: Callable[..., Project], stand: Make
) -> None:
    link = MqttLink("127.0.0.1", speaker.mqtt, routes={
        "lamp": TopicMapping("hall/lamp"), "mood": TopicMapping("hall/mood", "name", retain=True),
        "button": TopicMapping("hall/button")})  # fmt: skip
    here = stand(museum(mqtt=link))
    there = device("hall/lamp")
    there.send("hall/button", '{"number": 1}', retain=True)
    here.bus.publish("museum.mood", {"name": "früh"})
    module, pressed = added(here), here.listen(BUTTON)
    until(lambda: _reached(here, there))
    assert json.loads(there.came[-1][1]) == {"level": 1.0}
    here.bus.publish("museum.mood", {"name": "späte Stunde"})
    here.settle()
    kept = ("hall/mood", "späte Stunde".encode(), True)
    until(lambda: device("hall/mood").wait(1)[0] == kept)  # who comes before the broker has it hears it live
    assert pressed.bodies == [], "what the broker kept from before was pressed before"
    there.send("hall/button", '{"number": 2}')
    assert pressed.wait(1) == [{"number": 2}]
    before = module.refused
    for payload in ("no json", '{"number": 10}', '{"number": "x"}', "9" * (mqtt.MAX_PAYLOAD + 1)):
        there.send("hall/button", payload)
    until(lambda: module.refused == before + 4)
    assert any("`hall/button (MQTT)` are dropped: it is not JSON" in line for line in here.told)
    assert len([line for line in here.told if "hall/button" in line]) == 1
    for _ in range(200):
        there.send("hall/button", '{"number": 4}')
    until(lambda: module.refused > before + 4)
    assert len(pressed.bodies) < 150
    there.send("hall/button", b"", retain=True)


def _reached(here: Stand, there: Device) -> bool:
    """Return True if the lamp got a value; if not, publish once more, since it may not have listened yet."""
    if not there.came:
        here.bus.publish(LAMP, {"level": 1.0})
        here.settle()
    return bool(there.came)


@pytest.mark.broker
def test_a_broker_that_is_away_is_told_once_and_comes_back(
    museum: Callable[..., Project], stand: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(health, "STEADY", 0.1)
    rabbitmq = RabbitMQ(speaks_mqtt=True)
    routes = {"lamp": TopicMapping("hall/lamp"), "mood": TopicMapping("hall/mood", retain=True)}
    here = stand(museum(mqtt=MqttLink("127.0.0.1", rabbitmq.mqtt, routes=routes)))
    name = f"the MQTT broker 127.0.0.1:{rabbitmq.mqtt}"
    try:
        module = added(here)
        until(lambda: here.told == [f"{name} cannot be reached: Lumen keeps trying"])
        here.bus.publish(LAMP, {"level": 1.0})
        here.bus.publish("museum.mood", {"name": "late"})
        here.settle()
        assert here.told[1:] == ["messages on `lamp (MQTT)` are dropped: the broker is away"]
        assert module.refused == 1
        rabbitmq.start()
        until(lambda: here.told[2:] == [f"{name} is back"])
        lamp = Device(rabbitmq.mqtt, "hall/lamp", "hall/mood")
        try:
            assert lamp.wait(1) == [("hall/mood", b'{"name":"late"}', True)]
            here.bus.publish(LAMP, {"level": 0.25})
            assert json.loads(lamp.wait(2)[1][1]) == {"level": 0.25}
        finally:
            lamp.close()
        rabbitmq.kill()
        until(
            lambda: (
                here.told[3:] == [f"{name} has closed the connection: Lumen keeps trying to reach it"]
                or len(here.told) > 4
            )
        )
        assert all(name in line for line in here.told[2:])
    finally:
        rabbitmq.stop()


@pytest.mark.broker
def test_what_our_own_broker_carries_anyway_does_not_go_round_for_ever(
    speaker: RabbitMQ, device: Callable[..., Device], museum: Callable[..., Project]
) -> None:
    routes = {"lamp": TopicMapping("museum/lamp/set"), "button": TopicMapping("hall/button")}
    project = museum(mqtt=MqttLink("localhost", speaker.mqtt, routes=routes))
    bus, told, lamp, pressed = connect(speaker.url, project), list[str](), device("museum/lamp/set"), Collector()
    module = ShowControl(project, bus, told.append)
    module.begin()
    bus.subscribe(BUTTON, pressed)
    until(lambda: _asked(lamp, pressed))
    bus.publish(LAMP, {"level": 0.5})
    lamp.wait(1)
    lamp.send("hall/button", '{"number": 7}')
    until(lambda: {"number": 7} in pressed.bodies)
    assert len(lamp.came) == 1
    assert told == ["RabbitMQ already carries `lamp` to and from museum/lamp/set: delete it from `mqtt`"]
    module.close()
    bus.close()


def _asked(lamp: Device, pressed: Collector) -> bool:
    if not pressed.messages:
        lamp.send("hall/button", '{"number": 6}')
    return bool(pressed.messages)


@pytest.mark.broker
def test_a_wrong_password_is_told_and_no_device_stops_the_robot(
    speaker: RabbitMQ, museum: Callable[..., Project], stand: Make, device: Callable[..., Device], tmp_path: Any
) -> None:
    routes = {"stop": TopicMapping("hall/stop"), "button": TopicMapping("hall/button")}
    here = stand(museum(mqtt=MqttLink("127.0.0.1", speaker.mqtt, routes=routes)))
    module, there = added(here), device()
    stops, pressed = here.listen("avatar.NAO.stop"), here.listen(BUTTON)
    until(lambda: _asked_for(there, pressed))
    there.send("hall/stop", '{"type": "motion", "method": "rest"}')
    until(lambda: module.refused == 1)
    assert stops.bodies == []
    assert here.told == ["messages on `hall/stop (MQTT)` are dropped: devices may not send to the route `stop`"]
    (tmp_path / "mqtt").write_text("guest:wrong")
    other = stand(here.project)
    added(other)
    until(lambda: any("refuses the connection" in line for line in other.told))


def _asked_for(there: Device, pressed: Collector) -> bool:
    if not pressed.messages:
        there.send("hall/button", '{"number": 6}')
    return bool(pressed.messages)


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
def test_a_lamp_by_dmx(museum: Callable[..., Project], stand: Make) -> None:
    link = DmxLink(7, "127.0.0.1", {"lamp": {"level": 1, "on": 512}})
    came, ended = list[Any](), list[str]()
    receiver = sacn.sACNreceiver(bind_address="127.0.0.1")
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
    museum: Callable[..., Project], stand: Make
) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.3", 5568))
        receiver.setblocking(False)
        here = stand(museum(dmx=DmxLink(1, "127.0.0.3", {"lamp": {"level": 1}})))
        added(here)
        here.settle()
        with pytest.raises(BlockingIOError):
            receiver.recv(1000)
        here.bus.publish(LAMP, {"level": 1})
        receiver.settimeout(HANG)
        packets = [receiver.recv(1000) for _ in range(3)]
    assert [len(packet) for packet in packets] == [638] * 3
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
