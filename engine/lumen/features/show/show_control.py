"""The module `show`, which sends messages to devices, and limits, checks and counts the devices' messages."""

import socket
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from lumen.errors import BusError, ModuleError
from lumen.features.show.device_link import DeviceLink
from lumen.features.show.health import LinkHealth
from lumen.features.show.settings import MqttLink, Show, TopicMapping, may_come_from_devices
from lumen.language.modules import SHOW
from lumen.language.projects import Project
from lumen.language.routes import Direction
from lumen.ports import Bus, Message, MessageHandler, UsesBroker
from lumen.project.message_fields import SchemaField, message_fields
from lumen.run.module import Module
from lumen.upkeep.drops import Drops
from lumen.upkeep.ratelimit import RateLimiter

LACKING = "MQTT and OSC need two libraries: run `pip install 'lumen-robot[show]'`"
TICK = 0.2
"""The time between two checks of the devices [s]."""


class ShowControl(Module):
    """Sends routes to the devices of `modules.show`, and publishes the devices' messages on permitted routes.

    Missing devices, and messages that can't be sent, are only reported. Changed settings open new connections.
    """

    name = SHOW

    def __init__(self, project: Project, bus: Bus, tell: Callable[[str], None]) -> None:
        super().__init__(project, bus, tell)
        self._refused = Drops(self.tell)
        self._limiter, self._counting = RateLimiter(), threading.Lock()
        self._links: dict[str, DeviceLink] = {}
        self._linked: Project | None = None

    @property
    def refused(self) -> int:
        """The number of refused messages."""
        return sum(self._refused.counts.values())

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the handlers of the outgoing routes, by route."""
        show, routes = self.project.section(Show), self.project.routes
        out = [name for name in show.routes if name in routes and routes[name].direction is Direction.OUT]
        return {name: partial(self._send, name) for name in sorted(out)}

    def idle(self) -> float | None:
        """Update the links, and report refused messages; return the time until the next call [s]."""
        self._link()
        for link in self._links.values():
            link.tick()
        self._refused.tell()
        return TICK

    def end(self) -> None:
        """Close the links, and report refused messages."""
        self._unlink()
        self._refused.tell(all=True)

    def _send(self, route: str, message: Message) -> None:
        self._link()
        for name, link in self._links.items():
            if route in link.routes:
                try:
                    link.send(route, message.body)
                except ModuleError as error:
                    self._refused.add(f"{route} ({name.upper()})", str(error))

    def _deliver(self, route: str, place: str, make: Callable[[], Any]) -> None:
        """Publish a device's message, within the route's rate; called on the links' threads."""
        row = self.project.routes.get(route)
        if row is None or not may_come_from_devices(row):
            self._refused.add(place, f"devices may not send to the route `{route}`")
            return
        with self._counting:
            rate = row.rate
            if rate and self._limiter.wait(route, rate):
                self._refused.add(place, f"more than {rate:g} messages a second")
                return
            self.handled += 1
        try:
            self.bus.publish(row.key_for(self.project.robot), make(), ttl=row.ttl)
        except (ModuleError, BusError) as error:
            self._refused.add(place, str(error))

    def _link(self) -> None:
        """Reopen all links if the show settings, routes or message schemas have changed."""
        show, routes, messages = self.project.section(Show), self.project.routes, self.project.messages
        before = self._linked
        if before and (before.section(Show), before.routes, before.messages) == (show, routes, messages):
            return
        self._unlink()
        self._linked = self.project
        for name in ("mqtt", "osc", "dmx"):
            try:
                if found := getattr(self, f"_{name}")(show):
                    self._links[name] = found
                    found.begin()
            except (ModuleError, ImportError) as error:
                self.tell(f"{name}: {error}" if isinstance(error, ModuleError) else LACKING)

    def _unlink(self) -> None:
        for link in self._links.values():
            link.close()
        self._links = {}

    def _mqtt(self, show: Show) -> DeviceLink | None:
        if show.mqtt is None:
            return None
        from lumen.features.show.mqtt import MqttBroker

        link = replace(show.mqtt, routes=self._foreign(show.mqtt))
        return MqttBroker(
            link,
            self.project.routes,
            {name: self._fields(name).get(row.field) for name, row in link.routes.items()},
            self._incoming(link.routes),
            self._deliver,
            self._refused,
            self._health(f"the MQTT broker {link.host}:{link.port}"),
            f"lumen-{self.project.robot}",
        )

    def _osc(self, show: Show) -> DeviceLink | None:
        if show.osc is None:
            return None
        from lumen.features.show.osc import OscDevice

        link = show.osc
        fields = {}
        for name, row in link.routes.items():
            known = self._fields(name)
            fields[name] = [known[field] for field in (known if row.fields is None else row.fields) if field in known]
        health = self._health(f"the OSC device {link.host}:{link.port}")
        return OscDevice(link, fields, self._incoming(link.routes), self._deliver, self._refused, health)

    def _dmx(self, show: Show) -> DeviceLink | None:
        if show.dmx is None:
            return None
        from lumen.features.show.dmx import DmxUniverse

        link = show.dmx
        fields = {name: self._fields(name) for name in link.routes}
        return DmxUniverse(link, fields, f"Lumen {self.project.robot}", self._health(f"DMX universe {link.universe}"))

    def _foreign(self, link: MqttLink) -> Mapping[str, TopicMapping]:
        """Return the link's routes, without those that the bus's own broker already carries as MQTT.

        Report the routes left out; their messages would circulate forever.
        """
        project, routes = self.project, dict(link.routes)
        broker = self.bus.ability(UsesBroker)
        if broker is None or not same_machine(broker.host, link.host):
            return routes
        for name, row in link.routes.items():
            if name in project.routes and row.topic.replace("/", ".") == project.routes[name].key_for(project.robot):
                del routes[name]
                self.tell(f"RabbitMQ already carries `{name}` to and from {row.topic}: delete it from `mqtt`")
        return routes

    def _health(self, device: str) -> LinkHealth:
        return LinkHealth(device, self.tell, self.well)

    def _incoming(self, routes: Mapping[str, Any]) -> list[str]:
        known = self.project.routes
        return [name for name in routes if name in known and known[name].direction is Direction.IN]

    def _fields(self, route: str) -> Mapping[str, SchemaField]:
        """Return the fields of a route's bodies, by name; empty for an unknown route."""
        row = self.project.routes.get(route)
        return message_fields(self.project.messages.get(row.schema) if row else None)


def same_machine(one: str, other: str) -> bool:
    """Return whether two host names are equal or share an address; False for an empty or unknown name."""
    if not one or one == other:
        return bool(one)
    try:
        first, second = ({row[4][0] for row in socket.getaddrinfo(name, None)} for name in (one, other))
    except (OSError, UnicodeError):
        return False
    return bool(first & second)
