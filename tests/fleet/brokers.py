"""The brokers of a centre and of two houses, as `lumen fleet init` describes them, with cables that can be cut."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lumen.features.fleet.brokers import CENTRE, OPERATORS, PLUGINS, ROBOTS, write_settings
from lumen.features.fleet.settings import Fleet, FleetHouse
from tests.certificates import certify
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay

HOUSES = ("itb", "museum")


class FleetBrokers:
    """Three brokers on loopback, whose houses call the centre by TLS; `cables` are their lines to it."""

    def __init__(self, folder: Path, robots: Mapping[str, tuple[str, ...]]) -> None:
        certificates = folder / "certificates"
        self.ca = certificates / "ca.pem"
        certificates.mkdir(parents=True)
        certify(certificates, "DNS:localhost", days=90)
        self.brokers = {CENTRE: RabbitMQ(certificates, plugins=PLUGINS)}
        self.brokers |= {name: RabbitMQ(plugins=PLUGINS) for name in HOUSES}
        centre = self.brokers[CENTRE]
        self.cables = {name: Relay(centre.secure) for name in HOUSES}
        self.settings: dict[str, Any] = {}
        self.passwords: dict[str, Mapping[str, str]] = {}
        for name in HOUSES:  # each house calls by a cable of its own
            houses = {each: FleetHouse(self.brokers[each].url, robots[each]) for each in HOUSES}
            self.fleet = Fleet(f"amqps://localhost:{self.cables[name].port}/", houses=houses)
            write_settings(self.fleet, folder / "brokers", ca=str(certificates / "ca.pem"))
            self._read(folder / "brokers", name)
        self._read(folder / "brokers", CENTRE)
        for name, broker in self.brokers.items():
            broker.definitions = self.settings[name]

    def _read(self, folder: Path, name: str) -> None:
        self.settings[name] = json.loads((folder / name / "definitions.json").read_text())
        self.passwords[name] = json.loads((folder / name / "passwords.json").read_text())

    def start(self) -> None:
        """Side by side, since each waits for its disk and its plugins more than it calculates."""
        for broker in self.brokers.values():
            broker.begin()
        for broker in self.brokers.values():
            broker.wait()

    def url(self, name: str, user: str = "") -> str:
        """The address of a broker for one of its users: the robots of a house, the operators of the centre."""
        who = user or (OPERATORS if name == CENTRE else ROBOTS)
        return f"amqp://{who}:{self.passwords[name][who]}@127.0.0.1:{self.brokers[name].port}/"

    def close(self) -> None:
        for cable in self.cables.values():
            cable.close()
        for broker in self.brokers.values():
            broker.stop()
