"""Show control: the routes to and from devices with MQTT, OSC or DMX."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath
from lumen.language.routes import Direction, Route
from lumen.language.routing_keys import KEY_PREFIXES

MQTT_PORT, MQTT_TLS_PORT = 1883, 8883


@dataclass(frozen=True, slots=True)
class TopicMapping:
    """A route as an MQTT topic."""

    topic: str
    field: str = ""
    """The field that is sent as plain text; empty for the whole body as JSON."""
    retain: bool = False
    """Whether the broker keeps the newest message for later subscribers, and may send such a message to Lumen."""


@dataclass(frozen=True, slots=True)
class AddressMapping:
    """A route as an OSC address."""

    address: str
    fields: tuple[str, ...] | None = None
    """The fields that become the arguments, in order; None for all fields of the schema."""


@dataclass(frozen=True, slots=True)
class MqttLink:
    """An MQTT broker, and its routes."""

    host: str
    port: int = MQTT_PORT
    tls: bool = False
    routes: Mapping[str, TopicMapping] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class OscLink:
    """A device that receives OSC over UDP."""

    host: str
    port: int
    listen: int | None = None
    """The local port for the device's messages; None to receive no messages."""
    routes: Mapping[str, AddressMapping] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class DmxLink:
    """A DMX universe over sACN."""

    universe: int
    host: str = ""
    """The receiver's address; empty for multicast."""
    routes: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    """The channel of each field, by route."""


@dataclass(frozen=True, slots=True)
class Show:
    """The devices in `modules: {show: …}`."""

    mqtt: MqttLink | None = None
    osc: OscLink | None = None
    dmx: DmxLink | None = None

    @property
    def routes(self) -> frozenset[str]:
        """The routes of all links."""
        return frozenset(name for link in (self.mqtt, self.osc, self.dmx) if link for name in link.routes)


SHOW_PATH: NodePath = ("modules", "show")
"""The path of the settings in lumen.yaml."""


def may_come_from_devices(route: Route) -> bool:
    """Return whether devices may send on a route: only on incoming routes whose keys are not Lumen's own.

    Therefore no device can command a robot.
    """
    return route.direction is Direction.IN and route.key.split(".")[0] not in KEY_PREFIXES
