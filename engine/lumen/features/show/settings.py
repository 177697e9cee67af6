"""Show control: which routes go to devices that speak MQTT, OSC or DMX, and which come from there."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath
from lumen.language.routes import Direction, Route
from lumen.language.routing_keys import KEY_PREFIXES

MQTT_PORT, MQTT_TLS_PORT = 1883, 8883


@dataclass(frozen=True, slots=True)
class TopicMapping:
    """A route as a topic of MQTT: its whole body as JSON, or one `field` of it as bare text.

    `retain`: the broker keeps the newest for whoever comes later, and what it kept counts here when we come.
    """

    topic: str
    field: str = ""
    retain: bool = False


@dataclass(frozen=True, slots=True)
class AddressMapping:
    """A route as an address of OSC, whose arguments are these `fields`; None for those of its schema, in that order."""

    address: str
    fields: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class MqttLink:
    """A broker of MQTT, and the routes that it carries."""

    host: str
    port: int = MQTT_PORT
    tls: bool = False
    routes: Mapping[str, TopicMapping] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class OscLink:
    """A device that takes OSC over UDP; what it sends is heard on our port `listen`, None for nowhere."""

    host: str
    port: int
    listen: int | None = None
    routes: Mapping[str, AddressMapping] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class DmxLink:
    """A universe of DMX over sACN, to one `host` or (empty) by multicast; each route's fields have channels."""

    universe: int
    host: str = ""
    routes: Mapping[str, Mapping[str, int]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Show:
    """What `modules: {show: …}` says of the devices."""

    mqtt: MqttLink | None = None
    osc: OscLink | None = None
    dmx: DmxLink | None = None

    @property
    def routes(self) -> frozenset[str]:
        """All routes that any of them carries."""
        return frozenset(name for link in (self.mqtt, self.osc, self.dmx) if link for name in link.routes)


SHOW_PATH: NodePath = ("modules", "show")
"""Where in lumen.yaml it stands."""


def may_come_from_devices(route: Route) -> bool:
    """Whether devices may send on it: it comes in, under a key of the exhibition's own: no lamp commands a robot."""
    return route.direction is Direction.IN and route.key.split(".")[0] not in KEY_PREFIXES
