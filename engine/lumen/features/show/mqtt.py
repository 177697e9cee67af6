"""An MQTT 3.1.1 broker with routes as topics, through Eclipse Paho on a separate thread."""

import os
import secrets
import ssl
import threading
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import orjson
from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode, MQTTProtocolVersion

from lumen.errors import ModuleError
from lumen.features.show.device_link import TakeFromDevice
from lumen.features.show.health import LinkHealth
from lumen.features.show.settings import MqttLink
from lumen.language.routes import Carried, Route
from lumen.project.message_fields import FieldKind, SchemaField
from lumen.upkeep.drops import Drops
from lumen.upkeep.threads import WatchedThread


def payload_of(body: Any, field: SchemaField | None) -> bytes:
    """Return the body as JSON, or only `field` as plain text. Raises ModuleError if that is missing or invalid."""
    if field is None:
        return _json(body)
    if not isinstance(body, dict) or field.name not in body:
        raise ModuleError(f"the body has no `{field.name}`")
    value = body[field.name]
    try:
        return value.encode() if isinstance(value, str) else _json(value)
    except UnicodeEncodeError:
        raise ModuleError(f"`{field.name}` contains half of a surrogate pair") from None


def body_of_payload(payload: bytes, field: SchemaField | None) -> Any:
    """Return the body from a payload, which is text for a string field, else JSON. Raises ModuleError if invalid."""
    if field and field.kind is FieldKind.STRING:
        try:
            return {field.name: payload.decode()}
        except UnicodeDecodeError:
            raise ModuleError("it is not UTF-8 text") from None
    try:
        value = orjson.loads(payload)
    except orjson.JSONDecodeError:
        raise ModuleError("it is not JSON") from None
    return {field.name: value} if field else value


def _json(value: Any) -> bytes:
    try:
        return orjson.dumps(value)
    except TypeError as error:
        raise ModuleError(f"it cannot be written as JSON: {error}") from None


CREDENTIALS_VARIABLE = "LUMEN_MQTT_CREDENTIALS"
"""The environment variable with the path of a file that contains `NAME:PASSWORD`."""
MAX_PAYLOAD = 65_536
"""The maximum size of an accepted payload [bytes]."""
MAX_WAITING = 1_000
"""The maximum number of messages that wait for the broker's acknowledgement."""
FIRST_PAUSE, LONGEST_PAUSE = 1, 30
"""The first and the longest pause between two attempts to connect [s]; the pause doubles each time."""
KEEP_ALIVE = 15
"""The time without messages after which Lumen pings the broker [s]."""


class MqttBroker:
    """Publishes routes of `link`, and passes messages on the topics of `incoming` to `deliver`.

    Messages of `carried: telemetry` routes are sent at most once (QoS 0), all others at least once (QoS 1). While the
    broker is away, messages are refused, because a late command is worse than none. Only the newest message of each
    retained topic is sent later.
    """

    def __init__(
        self,
        link: MqttLink,
        routes: Mapping[str, Route],
        fields: Mapping[str, SchemaField | None],
        incoming: Sequence[str],
        deliver: TakeFromDevice,
        drops: Drops,
        health: LinkHealth,
        name: str = "lumen",
    ) -> None:
        self._link, self._routes, self._fields, self._deliver = link, routes, fields, deliver
        self._incoming = {link.routes[route].topic: route for route in incoming}
        self._drops, self._health = drops, health
        self._retained: dict[str, bytes] = {}
        self._closing, self._ordering = False, threading.Lock()
        self._client = self._made(f"{name}-{secrets.token_hex(4)}")
        self._thread = WatchedThread("lumen-show-mqtt", self._run)

    @property
    def routes(self) -> Collection[str]:
        """The routes that the broker carries."""
        return self._link.routes

    def begin(self) -> None:
        """Start connecting, without waiting."""
        self._thread.start()

    def send(self, route: str, body: Any) -> None:
        """Publish a body; while the broker is away, keep the body of a retained topic for later.

        Raises ModuleError if the body can't be sent, or if the broker is away and the topic is not retained.
        """
        row, mapping = self._routes[route], self._link.routes[route]
        payload = payload_of(body, self._fields[route])
        with self._ordering:
            if mapping.retain:
                self._retained[route] = payload
            if not self._client.is_connected():
                if mapping.retain:
                    return
                raise ModuleError("the broker is away")
            self._publish(mapping.topic, payload, row, retain=mapping.retain)

    def tick(self) -> None:
        """Update the connection's health."""
        if self._client.is_connected():
            self._health.up()
        self._health.tick()

    def close(self) -> None:
        """Disconnect and end the thread."""
        self._closing = True
        self._client.disconnect()
        self._thread.join(5.0)

    def _made(self, identity: str) -> Client:
        client = Client(
            CallbackAPIVersion.VERSION2, identity, clean_session=True, protocol=MQTTProtocolVersion.MQTTv311
        )
        if self._link.tls:
            client.tls_set_context(ssl.create_default_context())
        if file := os.environ.get(CREDENTIALS_VARIABLE):
            client.username_pw_set(*_credentials(file))
        client.reconnect_delay_set(FIRST_PAUSE, LONGEST_PAUSE)
        client.max_queued_messages_set(MAX_WAITING)
        client.on_connect = self._connected
        client.on_connect_fail = self._unreachable
        client.on_disconnect = self._disconnected
        client.on_subscribe = self._subscribed
        client.on_message = self._message
        return client

    def _run(self) -> None:
        if not self._closing:
            self._client.connect_async(self._link.host, self._link.port, KEEP_ALIVE)
            try:
                self._client.loop_forever(retry_first_connection=True)
            except UnicodeError:
                self._health.down("cannot be reached, because its name is not valid: correct `host`")

    def _publish(self, topic: str, payload: bytes, row: Route, *, retain: bool) -> None:
        quality = 0 if row.carried is Carried.TELEMETRY else 1
        try:
            done = self._client.publish(topic, payload, quality, retain)
        except ValueError as error:
            raise ModuleError(f"it cannot be published: {error}") from None
        if done.rc is not MQTTErrorCode.MQTT_ERR_SUCCESS:
            raise ModuleError(
                "the broker accepts no more messages"
                if done.rc is MQTTErrorCode.MQTT_ERR_QUEUE_SIZE
                else "the broker is not connected"
            )

    def _connected(self, client: Client, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if reason.is_failure:
            self._health.down(f"refuses the connection ({str(reason).lower()}): check {CREDENTIALS_VARIABLE}")
            return
        self._health.up()
        for topic in self._incoming:
            client.subscribe(topic, 1)
        with self._ordering:
            for route, payload in self._retained.items():
                self._publish(self._link.routes[route].topic, payload, self._routes[route], retain=True)

    def _unreachable(self, client: Client, data: Any) -> None:
        self._health.down("cannot be reached: Lumen keeps trying")

    def _disconnected(self, client: Client, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if not self._closing:
            self._health.down("has closed the connection: Lumen keeps trying to reach it")

    def _subscribed(self, client: Client, data: Any, number: int, reasons: Any, properties: Any) -> None:
        if any(reason.is_failure for reason in reasons):
            self._health.down("refuses a subscription to one of the topics")

    def _message(self, client: Client, data: Any, message: MQTTMessage) -> None:
        try:
            route = self._incoming.get(message.topic)
        except UnicodeDecodeError:
            route = None
        if route is None or (message.retain and not self._link.routes[route].retain):
            return
        place, payload, field = f"{message.topic} (MQTT)", bytes(message.payload), self._fields[route]
        if len(payload) > MAX_PAYLOAD:
            self._drops.add(place, f"it is longer than {MAX_PAYLOAD} bytes")
            return
        self._deliver(route, place, lambda: body_of_payload(payload, field))


def _credentials(file: str) -> tuple[str, str]:
    try:
        name, separator, password = Path(file).read_text("utf-8").strip().partition(":")
    except (OSError, UnicodeDecodeError) as error:
        raise ModuleError(f"the file `{file}` that {CREDENTIALS_VARIABLE} names cannot be read: {error}") from None
    if not separator or not name or "\n" in password:
        raise ModuleError(f"the file `{file}` that {CREDENTIALS_VARIABLE} names must contain one line `NAME:PASSWORD`")
    return name, password
