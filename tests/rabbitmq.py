"""A private RabbitMQ for the tests: on loopback only, run by the user who runs them, and ended with them in any case.

`broker` (servers.py) is a virtual host of the run's broker; a test that kills its broker, or needs TLS or a plug-in,
starts one of its own with `RabbitMQ()`. As a program (`make broker`) it is one for whoever develops a module, until
Ctrl-C.
"""

import base64
import hashlib
import json
import os
import random
import shlex
import shutil
import signal
import socket
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import NoReturn

import pytest

from tests import ROOT
from tests.erlang_modules import link_modules
from tests.guarded import Guarded, TimeoutExpired, temporary_folder
from tests.provided import lack
from tests.waiting import HANG

UNPACKED = ROOT / ".cache/debian"
"""The folder into which scripts/packages.sh unpacks packages without root."""
ROOTS = (Path("/"), UNPACKED / "root")
GIVEN = "LUMEN_TEST_BROKER"
"""The variable with the address of a broker for tests that need no more than one, in place of their own: amqp://…"""
START_TIMEOUT = HANG
"""The time that a broker may need until it listens, on a crowded machine [s]."""
STOP_TIMEOUT = 20.0
"""The time that it may need to end in order [s]."""
VIRTUAL_HOSTS = 64
"""The number of hosts of the run's broker, each for one module; 40 cost less than a second of processor time."""
HASHING = "rabbit_password_hashing_sha256"

ERLANG_ARGUMENTS = "-kernel inet_dist_use_interface {127,0,0,1} -kernel net_ticktime 60000 +S 1:1 +sbwt none"
"""`net_ticktime` is in seconds. RabbitMQ reads it as milliseconds: it checks each virtual host every four of them.

With Erlang's default of 60 seconds, 64 idle virtual hosts cost 2 % of a processor.
"""
USERS = {
    "guest": (".*", ".*"),
    "visual": (r"^lumen\.visual\.", r"^avatar\."),
    "lamp": (r"^museum\.button$", r"^museum\.lamp\."),
    "eyes": (r"^lumen\.(NAO\.)?visual\.", r"^avatar\.NAO\.data\.image$"),
}
"""The users of each virtual host: which keys of `amq.topic` each may write, and which read."""
RIGHTS = {
    "eyes": ("^amq\\.gen", "^(amq\\.topic|amq\\.gen|amq\\.default)", "^(amq\\.topic|amq\\.gen)"),
    "lamp": ("^mqtt-subscription", "^(amq\\.topic|mqtt-subscription)", "^(amq\\.topic|mqtt-subscription)"),
}
"""The limited rights of some users to configure, write and read, as in docs/deployment.md for a module."""

NOWHERE = {
    "vhost": "/",
    "name": "nowhere",
    "pattern": r"^amq\.topic$",
    "apply-to": "exchanges",
    "definition": {"alternate-exchange": "lumen.nowhere"},
}


class RabbitMQ:
    """A broker in a folder of its own; `url` is its address once `start` has returned.

    With a folder of certificates it listens for TLS too, on the port `secure`, and has the policy of docs/deployment.md
    for messages without a receiver. With `speaks_mqtt` its plug-in for MQTT listens on the port `mqtt`; `plugins` are
    others. With `virtual_hosts` it has so many, named `t0` and so on, in place of the usual one. `conf` replaces
    its settings; without one that imports definitions it begins as a new installation does.
    """

    host = ""
    """The virtual host; empty for the only one."""

    def __init__(
        self,
        certificate: Path | None = None,
        *,
        speaks_mqtt: bool = False,
        plugins: Sequence[str] = (),
        virtual_hosts: int = 0,
    ) -> None:
        self._root, self._script = _installed()
        self._hosts = [f"t{number}" for number in range(virtual_hosts)] or ["/"]
        self.certificate, self._speaks_mqtt, self._plugins = certificate, speaks_mqtt, plugins
        self.conf = ""
        self.folder = temporary_folder("lumen-rabbitmq-")
        self.port, self.distribution, self.epmd, self.secure, self.mqtt = _free_ports(5)
        self.url = self.url_of("guest")
        self._process: Guarded[bytes] | None = None
        self._names: Guarded[bytes] | None = None

    def url_of(self, user: str) -> str:
        """Return the address for one of `USERS`, whose password is the same as the name."""
        return f"amqp://{user}:{user}@{self.place()}"

    def place(self, port: int = 0) -> str:
        """Return the last part of an address: of this broker, or of a relay in front of it."""
        return f"127.0.0.1:{port or self.port}/{self.host}"

    @property
    def ctl(self) -> str:
        """Return the command that calls rabbitmqctl for this broker."""
        environment = [f"{name}={value}" for name, value in self._environment().items()]
        tool = Path(self._script).with_name("rabbitmqctl")
        return shlex.join(["env", *environment, str(tool), "-n", f"t{self.port}@localhost"])

    def start(self) -> None:
        """Start it, or restart it with its stored data, and wait until it accepts connections."""
        self.begin()
        self.wait()

    def begin(self) -> None:
        """Start it; call `wait` before using it."""
        plugins = (*self._plugins, *["rabbitmq_mqtt"] * self._speaks_mqtt)
        (self.folder / "plugins").write_text(f"[{','.join(plugins)}].")
        (self.folder / "rabbitmq.conf").write_text(self.conf or "\n".join(self._settings()))
        (self.folder / "definitions.json").write_text(
            json.dumps(_definitions(self._hosts, nowhere=self.certificate is not None))
        )
        link_modules(self.folder, self._root / "usr/lib/erlang", Path(self._script).parents[1], self._plugins)
        if self._names is None:
            # Begun by us, since the one that Erlang begins for itself makes itself a daemon, which outlives everybody.
            self._names = self._begin("epmd", "-address", "127.0.0.1", "-port", str(self.epmd))
            self._await(self._names, lambda: _listens(self.epmd))
        self._process = self._begin(self._script)

    def wait(self) -> None:
        """Return once it accepts connections."""
        assert self._process
        self._await(self._process, lambda: _speaks_amqp(self.port))
        if self._speaks_mqtt:
            self._await(self._process, lambda: _listens(self.mqtt))

    def _begin(self, *command: str) -> Guarded[bytes]:
        with (self.folder / "log").open("ab") as log:
            return Guarded(command, env=self._environment(), stdout=log, stderr=log)

    def _await(self, process: Guarded[bytes], ready: Callable[[], bool]) -> None:
        deadline = time.monotonic() + START_TIMEOUT
        while not ready():
            if process.poll() is not None or time.monotonic() > deadline:
                said = self._said()
                self.stop()
                pytest.fail(f"RabbitMQ did not start; it said:\n{said}", pytrace=False)
            time.sleep(0.1)

    def _settings(self) -> list[str]:
        """Return the settings: users, and with a certificate (`server.pem`, `server.key`, signed by `ca.pem`) a port
        for TLS.
        """
        settings = [f"load_definitions = {self.folder}/definitions.json"]
        if self._speaks_mqtt:
            settings += [f"mqtt.listeners.tcp.1 = 127.0.0.1:{self.mqtt}", "mqtt.allow_anonymous = false"]
        if self.certificate:
            names = (("cacertfile", "ca.pem"), ("certfile", "server.pem"), ("keyfile", "server.key"))
            settings.append(f"listeners.ssl.1 = 127.0.0.1:{self.secure}")
            settings += [f"ssl_options.{option} = {self.certificate}/{file}" for option, file in names]
        return [*settings, ""]

    @property
    def runs(self) -> bool:
        """Return whether it was started and has not ended."""
        return self._process is not None and self._process.poll() is None

    def kill(self) -> None:
        """End it as a power cut would."""
        _end(self._process, signal.SIGKILL)
        self._process = None

    def signal(self, number: int) -> None:
        """Send it a signal, as SIGSTOP and SIGCONT for one that hangs."""
        assert self._process
        os.killpg(self._process.pid, number)

    def stop(self) -> None:
        """End it and its name server, and delete its folder: what it has stored is not worth an end in order."""
        for process in (self._process, self._names):
            _end(process, signal.SIGKILL)
        self._process = self._names = None
        shutil.rmtree(self.folder, ignore_errors=True)

    def _environment(self) -> dict[str, str]:
        folder = str(self.folder)
        return {
            "PATH": f"{self._root / 'usr/bin'}:{os.environ['PATH']}",
            "LANG": "C.UTF-8",
            "HOME": folder,
            "RABBITMQ_CONF_ENV_FILE": "/dev/null",
            "RABBITMQ_NODENAME": f"t{self.port}@localhost",
            "RABBITMQ_NODE_IP_ADDRESS": "127.0.0.1",
            "RABBITMQ_NODE_PORT": str(self.port),
            "RABBITMQ_DIST_PORT": str(self.distribution),
            "RABBITMQ_MNESIA_BASE": f"{folder}/data",
            "RABBITMQ_LOG_BASE": f"{folder}/logs",
            "RABBITMQ_PID_FILE": f"{folder}/pid",
            "RABBITMQ_PLUGINS_DIR": f"{folder}/links",
            "RABBITMQ_ENABLED_PLUGINS_FILE": f"{folder}/plugins",
            "RABBITMQ_CONFIG_FILE": f"{folder}/rabbitmq.conf",
            "RABBITMQ_SERVER_ADDITIONAL_ERL_ARGS": f"-pa {folder}/modules {ERLANG_ARGUMENTS}",
            "ERL_EPMD_ADDRESS": "127.0.0.1",
            "ERL_EPMD_PORT": str(self.epmd),
        }

    def _said(self) -> str:
        log = self.folder / "log"
        return log.read_text(errors="replace")[-2000:] if log.exists() else "nothing"


class LentBroker(RabbitMQ):
    """A virtual host of a broker that others use, too: it can't be ended or set up."""

    def __init__(self, port: int, epmd: int, host: str) -> None:
        self.port, self.epmd, self.host = port, epmd, host
        self.certificate = None
        self.url = self.url_of("guest")

    def __getattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"`broker` has no `{name}`, since others use it: start one by `RabbitMQ()`")

    def begin(self) -> NoReturn:
        self.__getattr__("begin")

    start = wait = kill = stop = begin


class GivenBroker:
    """A broker that was started elsewhere and stays in use: these tests neither end it nor set it up."""

    certificate = None

    def __init__(self, url: str) -> None:
        self.url = url

    def __getattr__(self, name: str) -> NoReturn:
        """Skip the test: it needs an ability that only a broker of our own has."""
        pytest.skip(f"{GIVEN} names a broker that is not ours: what needs its users, its end or TLS is left out")

    def url_of(self, user: str) -> str:
        """Return the address for a user: there is only the one that was given."""
        return self.url if user == "guest" else self.__getattr__("url_of")


def _end(process: Guarded[bytes] | None, how: signal.Signals) -> None:
    """End a process and its children, by force if they take too long."""
    if process is None:
        return
    try:
        os.killpg(process.pid, how)
        process.wait(STOP_TIMEOUT)
    except ProcessLookupError:
        process.wait()
    except TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _definitions(hosts: Sequence[str], *, nowhere: bool) -> dict[str, object]:
    """Return the definitions: each host with all users; `nowhere` sends unroutable messages to `lumen.nowhere`."""
    return {
        "vhosts": [{"name": host} for host in hosts],
        "users": [
            {"name": user, "password_hash": _hashed(user), "hashing_algorithm": HASHING, "tags": ""} for user in USERS
        ],
        "permissions": [
            {"user": user, "vhost": host, **dict(zip(("configure", "write", "read"), _rights(user), strict=True))}
            for host in hosts
            for user in USERS
        ],
        "policies": [NOWHERE] if nowhere else [],
        "topic_permissions": [
            {"user": user, "vhost": host, "exchange": "amq.topic", "write": write, "read": read}
            for host in hosts
            for user, (write, read) in USERS.items()
        ],
    }


def _rights(user: str) -> tuple[str, str, str]:
    return RIGHTS.get(user, (".*", ".*", ".*"))


def _hashed(password: str) -> str:
    """Return the password hash in RabbitMQ's form: four bytes of salt, and SHA-256 of salt and password."""
    salt = b"salt"
    return base64.b64encode(salt + hashlib.sha256(salt + password.encode()).digest()).decode()


def _installed() -> tuple[Path, str]:
    """Return the folder beneath which RabbitMQ is installed, and its script; skip or fail the test without it."""
    for root in ROOTS:
        if found := sorted(root.glob("usr/lib/rabbitmq/lib/rabbitmq_server-*/sbin/rabbitmq-server")):
            return root, str(found[-1])
    lack("rabbitmq-server")


def _free_ports(count: int) -> list[int]:
    """Return free ports below those that the system gives to clients, which could take the port of a killed broker."""
    with ExitStack() as held:
        ports: list[int] = []
        while len(ports) < count:
            port = random.SystemRandom().randrange(10_000, 32_768)
            with suppress(OSError):
                held.enter_context(socket.socket()).bind(("127.0.0.1", port))
                ports.append(port)
        return ports


def _listens(port: int) -> bool:
    try:
        socket.create_connection(("127.0.0.1", port), timeout=1.0).close()
    except OSError:
        return False
    return True


def _speaks_amqp(port: int) -> bool:
    """Return whether a broker answers there: to a wrong version of the protocol it sends its own."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=1.0) as connection:
            connection.sendall(b"AMQP\x00\x00\x00\x00")
            return connection.recv(4) == b"AMQP"
    except OSError:
        return False


def serve() -> None:
    """Run a broker until Ctrl-C, and print its address."""
    rabbitmq = RabbitMQ()
    print("starting RabbitMQ …", flush=True)
    rabbitmq.start()
    try:
        print(
            f"A private RabbitMQ listens on loopback, until Ctrl-C. Type, in another terminal:\n\n"
            f"    export LUMEN_BUS={rabbitmq.url}\n    lumen run\n",
            flush=True,
        )
        signal.pause()
    except KeyboardInterrupt:
        print("stopping it …", flush=True)
    finally:
        rabbitmq.stop()


if __name__ == "__main__":
    serve()
