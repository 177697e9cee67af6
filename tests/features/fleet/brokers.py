"""The brokers of a centre and of two houses, set up as docs/fleet-brokers.md describes, with cables that can be cut."""

import os
import re
import shlex
import shutil
from pathlib import Path

from tests import ROOT
from tests.certificates import certify
from tests.guarded import run_guarded
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay

PAGE = ROOT / "docs/fleet-brokers.md"
CENTRE, HOUSES = "centre", ("itb", "hall")
UP, DOWN = "lumen.fleet.up", "lumen.fleet"
"""At the centre, the exchange to which houses send, and the one from which they receive."""
FOLDER, HOST = "/etc/rabbitmq", "centre.museum.example"
"""The folder and the host of the page."""
RABBITMQCTL = """#!/bin/sh
if [ "$1" = add_user ]; then echo "NAME-$2" | COMMAND "$@"; else COMMAND "$@"; fi
"""
"""A `rabbitmqctl` for one broker, which types a password when it is asked for one."""


class FleetBrokers:
    """Three brokers on loopback, whose houses call the centre by TLS; `cables` are their lines to it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        certify(folder, "DNS:localhost")
        centre, house = blocks("sh")
        self._commands = {CENTRE: centre, **dict.fromkeys(HOUSES, house)}
        self.brokers = {name: RabbitMQ(folder, plugins=_plugins(text)) for name, text in self._commands.items()}
        self.cables = {name: Relay(self.brokers[CENTRE].secure) for name in HOUSES}

    def start(self) -> None:
        """Start the brokers together, because each mostly waits for its disk and its plugins; then set them up."""
        for name, broker in self.brokers.items():
            broker.conf = self._write_files(name)
            broker.begin()
        for broker in self.brokers.values():
            broker.wait()
        for name, commands in self._commands.items():
            self.follow(name, commands)

    def follow(self, name: str, commands: str) -> str:
        """Type commands of the page on the machine of that broker; return what they print."""
        machine = self._folder / name
        done = run_guarded(
            ["sh", "-e", "-c", commands.replace(FOLDER, str(machine))],
            env={"PATH": f"{machine}:{os.environ['PATH']}"},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, f"{name}: {done.stdout}{done.stderr}"
        return str(done.stdout)

    def url(self, name: str, user: str = "") -> str:
        """Return the address of a broker for one of its users: the robots of a house, the operators of the centre."""
        who = user or ("operators" if name == CENTRE else "robots")
        return f"amqp://{who}:{name}-{who}@127.0.0.1:{self.brokers[name].port}/"

    def _write_files(self, name: str) -> str:
        """Write the page's files and tools for the machine of a broker; return the settings of RabbitMQ."""
        machine, broker = self._folder / name, self.brokers[name]
        machine.mkdir()
        for file in ("ca.pem", "server.pem", "server.key"):
            shutil.copy(self._folder / file, machine)
        shutil.copy(self._folder / "ca.pem", machine / "centre-ca.pem")
        (machine / "rabbitmqctl").write_text(RABBITMQCTL.replace("NAME", name).replace("COMMAND", broker.ctl))
        (machine / "rabbitmqctl").chmod(0o700)
        (machine / "rabbitmq-plugins").symlink_to(shutil.which("true") or "")  # it began with them
        [conf], (centre, house) = blocks("ini"), blocks("json")
        (machine / "centre.json").write_text(centre)
        if name != CENTRE:
            line = f"@localhost:{self.cables[name].port}?"
            house = house.replace("itb", name).replace("PASSWORD", f"{CENTRE}-{name}").replace(FOLDER, str(machine))
            (machine / "house.json").write_text(house.replace(f"@{HOST}?", line).replace(HOST, "localhost"))
        ports = {"127.0.0.1:5672": broker.port, "5671": broker.secure}
        for port, own in ports.items():
            conf = conf.replace(port, f"127.0.0.1:{own}")
        return conf.replace(FOLDER, str(machine))

    def close(self) -> None:
        for cable in self.cables.values():
            cable.close()
        for broker in self.brokers.values():
            broker.stop()


def blocks(language: str) -> list[str]:
    """Return the blocks of code of the page in that language: the centre's first, then a house's."""
    return re.findall(rf"(?m)^```{language}\n([\s\S]*?)^```$", PAGE.read_text(encoding="utf-8"))


def _plugins(commands: str) -> list[str]:
    """Return the plugins that the commands enable."""
    return [word for word in shlex.split(commands) if word.startswith("rabbitmq_")]
