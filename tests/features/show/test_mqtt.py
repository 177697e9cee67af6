"""Routes to MQTT and back, with real clients on loopback."""

import json
from collections.abc import Callable, Iterator
from contextlib import closing
from typing import Any
from unittest.mock import Mock

import pytest
from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode

from lumen.bus import connect
from lumen.features.show import health, mqtt, show_control
from lumen.features.show.module import ShowControl
from lumen.features.show.settings import MqttLink, TopicMapping
from lumen.language.projects import Project
from lumen.upkeep.ratelimit import BURST, RateLimiter
from tests.features.conftest import Stand
from tests.features.show.linked import BUTTON, LAMP, ROUTES, Make, added
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until


@pytest.fixture(scope="module")
def speaker() -> Iterator[RabbitMQ]:
    """A RabbitMQ that speaks MQTT."""
    rabbitmq = RabbitMQ(speaks_mqtt=True)
    rabbitmq.start()
    yield rabbitmq
    rabbitmq.stop()


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
    speaker: RabbitMQ,
    device: Callable[..., Device],
    museum: Callable[..., Project],
    stand: Make,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(show_control, "RateLimiter", lambda: RateLimiter(lambda: 0.0))
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
    until(lambda: module.refused - before - 4 + len(pressed.bodies) - 1 == 200)
    assert len(pressed.bodies) <= BURST * here.project.routes["button"].rate
    there.send("hall/button", b"", retain=True)


def _reached(here: Stand, there: Device) -> bool:
    """Return True if the lamp got a value; if not, publish once more, since it may not have listened yet."""
    if not there.came:
        here.bus.publish(LAMP, {"level": 1.0})
        here.settle()
    return bool(there.came)


def _kept(port: int) -> tuple[str, bytes, bool]:
    """Return the first mood that a new device gets: it may come live if it is there before the broker keeps it."""
    with closing(Device(port, "hall/mood")) as device:
        return device.wait(1)[0]


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
        until(lambda: here.told[-1] == f"{name} is back")  # a broker that starts may refuse once
        there = len(here.told)
        until(lambda: _kept(rabbitmq.mqtt) == ("hall/mood", b'{"name":"late"}', True))
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
                here.told[there:] == [f"{name} has closed the connection: Lumen keeps trying to reach it"]
                or len(here.told) > there + 1
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
    until(lambda: _pressed(lamp, pressed))
    bus.publish(LAMP, {"level": 0.5})
    lamp.wait(1)
    lamp.send("hall/button", '{"number": 7}')
    until(lambda: {"number": 7} in pressed.bodies)
    assert len(lamp.came) == 1
    assert told == ["RabbitMQ already carries `lamp` to and from museum/lamp/set: delete it from `mqtt`"]
    module.close()
    bus.close()


def _pressed(button: Device, pressed: Collector) -> bool:
    """Return True if a press of the button arrived; if not, press it once more, since the module may listen late."""
    if not pressed.messages:
        button.send("hall/button", '{"number": 6}')
    return bool(pressed.messages)


def test_a_newer_retained_value_is_not_followed_by_an_older_one() -> None:
    link = MqttLink("localhost", routes={"mood": TopicMapping("museum/mood", retain=True)})
    broker = mqtt.MqttBroker(link, {"mood": ROUTES["mood"]}, {"mood": None}, [], Mock(), Mock(), Mock())
    alone = list[bool]()

    def publish(*_: object) -> Mock:
        alone.append(broker._ordering.locked())
        return Mock(rc=MQTTErrorCode.MQTT_ERR_SUCCESS)

    broker._client = client = Mock(publish=publish)
    broker.send("mood", {"name": "calm"})
    broker._connected(client, None, None, Mock(is_failure=False), None)
    assert alone == [True, True]


@pytest.mark.broker
def test_a_wrong_password_is_told_and_no_device_stops_the_robot(
    speaker: RabbitMQ, museum: Callable[..., Project], stand: Make, device: Callable[..., Device], tmp_path: Any
) -> None:
    routes = {"stop": TopicMapping("hall/stop"), "button": TopicMapping("hall/button")}
    here = stand(museum(mqtt=MqttLink("127.0.0.1", speaker.mqtt, routes=routes)))
    module, there = added(here), device()
    stops, pressed = here.listen("avatar.NAO.stop"), here.listen(BUTTON)
    until(lambda: _pressed(there, pressed))
    there.send("hall/stop", '{"type": "motion", "method": "rest"}')
    until(lambda: module.refused == 1)
    assert stops.bodies == []
    assert here.told == ["messages on `hall/stop (MQTT)` are dropped: devices may not send to the route `stop`"]
    (tmp_path / "mqtt").write_text("guest:wrong")
    other = stand(here.project)
    added(other)
    until(lambda: any("refuses the connection" in line for line in other.told))
