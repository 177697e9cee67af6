"""What RabbitMQ is told for a fleet: users, rights, exchanges, and what crosses between a house and the centre.

A house calls, and opens no port to anybody. Down, the centre's exchange `lumen.fleet` is federated into the house's.
Up, a shovel sends what waits in a queue: with the line cut it waits there. Both go by the house's own user at the
centre, which hears and says only what is of that house.
"""

import base64
import hashlib
import json
import os
import re
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlsplit

from lumen.errors import UsageError
from lumen.features.fleet.keys import BUNDLE, DESIRED, EXCHANGE, KEPT, PRESENCE, bundle_key, desired_key
from lumen.features.fleet.settings import Fleet
from lumen.upkeep.private_folder import private_folder

CENTRE = "centre"
UP = f"{EXCHANGE}.up"
"""At the centre, the exchange that houses write to; in a house, the queue of what is on its way there."""
STREAM = f"{EXCHANGE}.log"
"""At the centre, the stream of incidents and numbers: it is read on from where it was left."""
ROBOTS, OPERATORS = "robots", "operators"
"""Who uses the broker of a house, and who that of the centre."""
EVERYTHING = ".*"
PLUGINS = ("rabbitmq_federation", "rabbitmq_shovel")
HASHING = "rabbit_password_hashing_sha256"
MOST_WAITING = 50_000
"""Messages that wait in a house for the line to the centre; then the oldest give way."""
LINK_EXPIRES = 3_600_000
"""After how long without a house the centre forgets what waits for it [ms]: orders are told again."""
TOPIC = "amq.topic"
WAITING = {
    "x-queue-type": "quorum",
    "x-max-length": MOST_WAITING,
    "x-overflow": "drop-head",
    "x-delivery-limit": 1_000_000,
}
"""Of the queue in a house: on its disk, so that a power cut loses no incident, however often the line breaks."""
KEPT_AT_CENTRE = {
    "x-queue-type": "stream",
    "x-max-age": "30D",
    "x-max-length-bytes": 200_000_000,
    "x-stream-max-segment-size-bytes": 4_000_000,
}
"""Of the stream: what is older, or more, gives way in pieces of 4 MB."""


class BrokerSettings:
    """The files of one broker: `definitions` to import, its `conf`, and the passwords of its users."""

    def __init__(self, definitions: Mapping[str, Any], conf: str, passwords: Mapping[str, str]) -> None:
        self.definitions, self.conf, self.passwords = definitions, conf, passwords


def house_settings(fleet: Fleet, house: str, own: Mapping[str, str], upstream: str, *, ca: str = "") -> BrokerSettings:
    """Of a house's broker; `own` are the passwords of its users, `upstream` that of the house at the centre.

    `ca` is the file of the authority that has signed the centre's certificate, as the house's broker sees it.
    """
    address = _with_user(fleet.centre, house, upstream, ca)
    down = [_link(EXCHANGE, TOPIC, "exchange", key) for key in (desired_key(house), bundle_key(house))]
    up = [_link(TOPIC, UP, "queue", f"{key}.{house}.*") for key in (PRESENCE, *KEPT)]
    shovel = {
        "src-protocol": "amqp091",
        "src-uri": "amqp://",
        "src-queue": UP,
        "dest-protocol": "amqp091",
        "dest-uri": address,
        "dest-exchange": UP,
        "ack-mode": "on-confirm",
        "reconnect-delay": 2,
    }
    federation = {
        "uri": address,
        "exchange": EXCHANGE,
        "max-hops": 1,
        "expires": LINK_EXPIRES,
        "message-ttl": 60_000,
        "reconnect-delay": 2,
        "ack-mode": "on-confirm",
    }
    definitions = {
        **_users(own, {ROBOTS: (f"^(?!{re.escape(EXCHANGE)}).*", f"^(?!{re.escape(EXCHANGE)}).*", EVERYTHING)}),
        "exchanges": [_exchange(EXCHANGE)],
        "queues": [{"vhost": "/", "name": UP, "durable": True, "auto_delete": False, "arguments": WAITING}],
        "bindings": [*down, *up],
        "parameters": [
            {"vhost": "/", "component": "federation-upstream", "name": CENTRE, "value": federation},
            {"vhost": "/", "component": "shovel", "name": UP, "value": shovel},
        ],
        "policies": [
            {
                "vhost": "/",
                "name": EXCHANGE,
                "pattern": f"^{re.escape(EXCHANGE)}$",
                "apply-to": "exchanges",
                "definition": {"federation-upstream": CENTRE},
            }
        ],
    }
    return BrokerSettings(definitions, _conf(), own)


def centre_settings(fleet: Fleet, own: Mapping[str, str]) -> BrokerSettings:
    """Of the centre's broker; `own` are the passwords of its users, each house one."""
    link = "^federation: .*"
    rights = {OPERATORS: (EVERYTHING, EVERYTHING, EVERYTHING)}
    rights |= {
        house: (link, f"^(federation: .*|{re.escape(UP)})$", f"^(federation: .*|{re.escape(EXCHANGE)})$")
        for house in fleet.houses
    }
    topics = []
    for house in fleet.houses:
        name = re.escape(house)
        heard, said = rf"^fleet\.(desired|bundle)\.{name}$", rf"^fleet\.(presence|incident|numbers)\.{name}\."
        topics += [_topic(house, EXCHANGE, "^$", heard), _topic(house, UP, said, "^$")]
    definitions = {
        **_users(own, rights),
        "topic_permissions": topics,
        "exchanges": [_exchange(EXCHANGE), _exchange(UP)],
        "queues": [{"vhost": "/", "name": STREAM, "durable": True, "auto_delete": False, "arguments": KEPT_AT_CENTRE}],
        "bindings": [
            *(_link(TOPIC, EXCHANGE, "exchange", f"{key}.*") for key in (DESIRED, BUNDLE)),
            *(_link(UP, TOPIC, "exchange", f"{key}.*.*") for key in (PRESENCE, *KEPT)),
            *(_link(UP, STREAM, "queue", f"{key}.*.*") for key in KEPT),
        ],
        "parameters": [],
        "policies": [],
    }
    return BrokerSettings(definitions, _conf(), own)


def write_settings(fleet: Fleet, folder: Path, *, ca: str = "") -> list[Path]:
    """Write what each broker of the fleet needs into a folder of its own; the files, for their owner alone.

    Passwords that stand there stay. Raises UsageError.
    """
    if not fleet.centre:
        raise UsageError("fleet.yaml has no `centre: {broker: …}`: add it, so that houses can connect")
    try:
        private_folder(folder)
        centre = _passwords(folder / CENTRE, (OPERATORS, *fleet.houses))
        rows = {CENTRE: centre_settings(fleet, centre)}
        for house in fleet.houses:
            rows[house] = house_settings(fleet, house, _passwords(folder / house, (ROBOTS,)), centre[house], ca=ca)
        written = []
        for name, settings in rows.items():
            files = {
                "definitions.json": json.dumps(settings.definitions, indent=2),
                "rabbitmq.conf": settings.conf,
                "enabled_plugins": f"[{','.join(PLUGINS)}].\n",
                "passwords.json": json.dumps(dict(settings.passwords), indent=2),
            }
            written += [_write(folder / name / file, text) for file, text in files.items()]
    except OSError as error:
        raise UsageError(f"{error.filename or folder} can't be written: {error.strerror}") from None
    return written


def _passwords(folder: Path, users: tuple[str, ...]) -> dict[str, str]:
    private_folder(folder)
    try:
        known = json.loads((folder / "passwords.json").read_text())
    except (OSError, ValueError):
        known = {}
    kept = known if isinstance(known, dict) else {}
    return {user: str(kept.get(user) or secrets.token_urlsafe(24)) for user in users}


def _write(file: Path, text: str) -> Path:
    handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with open(handle, "w", encoding="utf-8") as opened:
        opened.write(text)
    return file


def _with_user(address: str, user: str, password: str, ca: str) -> str:
    """An address that a broker calls; by TLS it wants to know whom it speaks with."""
    parts = urlsplit(address)
    host = parts.netloc.rpartition("@")[2]
    checks = f"?verify=verify_peer&server_name_indication={parts.hostname}" if parts.scheme == "amqps" else ""
    checks += f"&cacertfile={quote(ca)}" if checks and ca else ""
    return f"{parts.scheme}://{quote(user)}:{quote(password, safe='')}@{host}{checks}"


def _users(passwords: Mapping[str, str], rights: Mapping[str, tuple[str, str, str]]) -> dict[str, Any]:
    return {
        "vhosts": [{"name": "/"}],
        "users": [
            {"name": user, "password_hash": _hashed(password), "hashing_algorithm": HASHING, "tags": ""}
            for user, password in passwords.items()
        ],
        "permissions": [
            {"user": user, "vhost": "/", **dict(zip(("configure", "write", "read"), row, strict=True))}
            for user, row in rights.items()
        ],
    }


def _hashed(password: str) -> str:
    """As RabbitMQ stores it: four bytes of salt, and SHA-256 of salt and password."""
    salt = secrets.token_bytes(4)
    return base64.b64encode(salt + hashlib.sha256(salt + password.encode()).digest()).decode()


def _exchange(name: str) -> dict[str, Any]:
    common = {"durable": True, "auto_delete": False, "internal": False, "arguments": {}}
    return {"vhost": "/", "name": name, "type": "topic", **common}


def _link(source: str, destination: str, kind: str, key: str) -> dict[str, Any]:
    return {
        "vhost": "/",
        "source": source,
        "destination": destination,
        "destination_type": kind,
        "routing_key": key,
        "arguments": {},
    }


def _topic(user: str, exchange: str, write: str, read: str) -> dict[str, str]:
    return {"vhost": "/", "user": user, "exchange": exchange, "write": write, "read": read}


def _conf() -> str:
    return """# Written by `lumen fleet init`. Put it into /etc/rabbitmq/, with the other files and the certificates.
load_definitions = /etc/rabbitmq/definitions.json
listeners.tcp.1 = 127.0.0.1:5672
listeners.ssl.1 = 5671
ssl_options.cacertfile = /etc/rabbitmq/ca.pem
ssl_options.certfile = /etc/rabbitmq/server.pem
ssl_options.keyfile = /etc/rabbitmq/server.key
ssl_options.versions.1 = tlsv1.3
ssl_options.versions.2 = tlsv1.2
max_message_size = 33554432
"""
