"""The console as an HTTP server on a port of this machine, until a signal ends it."""

import asyncio
import ipaddress
import signal
import socket
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import uvicorn

from lumen.errors import UsageError
from lumen.features.console.access import Access, secret_in
from lumen.features.console.connections import KnownConnection
from lumen.features.console.gate import LOOPBACK, Gate
from lumen.features.console.people import Role
from lumen.features.console.proxies import TrustedProxies
from lumen.features.console.site import Site
from lumen.features.console.watch import Watch
from lumen.run.reaching import Reached

END_TIMEOUT = 1
"""The time limit for open requests when the server ends [s]."""


class Console:
    """Listens at `address` from its construction, and serves in `run` until a signal or `end`.

    `reach` opens the bus of the project in `root`. Without `pins`, every client may do everything, so the console must
    be on loopback and behind no proxy. `hosts` are other names of this machine, `proxies` the addresses of trusted
    proxies. Port 0 selects any free port. Raises UsageError if PINs are missing or the port is not available.
    """

    def __init__(
        self,
        reach: Callable[[], Reached],
        root: Path,
        host: str,
        port: int,
        *,
        pins: Mapping[Role, str] | None = None,
        hosts: Iterable[str] = (),
        proxies: Iterable[str] = (),
    ) -> None:
        local, trusted = is_loopback(host), tuple(proxies)
        if not (local and not trusted) and not pins:
            how = "through a proxy" if local else f"on {host}"
            raise UsageError(
                f"other machines can reach the console {how}, but no PINs are set: write `console: "
                "{pins: {operator: $LUMEN_PIN}}` into lumen.yaml, and the PIN into that environment variable; or leave "
                "out `--host`"
            )
        self._listener = _listen(host, port)
        shown = f"[{host}]" if ":" in host else host
        self.address = f"http://{shown}:{self._listener.getsockname()[1]}/"
        self.site = Site(Watch(reach, root), Access(pins or {}, secret_in(root) if pins else b""), root)
        gate = Gate(self.site.app, {host, *hosts, *(LOOPBACK if local else ())}, TrustedProxies(trusted))
        config = uvicorn.Config(
            gate, log_level="warning", access_log=False, lifespan="on", server_header=False, date_header=False,
            proxy_headers=False, ws="none", http=KnownConnection, loop="asyncio", timeout_graceful_shutdown=END_TIMEOUT,
        )  # fmt: skip
        self._server = _Server(config, self.site)

    def run(self) -> None:
        """Serve until SIGINT, SIGTERM or `end`."""
        try:
            asyncio.run(self._server.serve([self._listener]))
        finally:
            self._listener.close()

    def end(self) -> None:
        """Make `run` return. Any thread may call it."""
        self._server.should_exit = True


class _Server(uvicorn.Server):
    """Ends the streams before it shuts down, because they would never end by themselves."""

    def __init__(self, config: uvicorn.Config, site: Site) -> None:
        super().__init__(config)
        self._site = site

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Restore the handlers but, unlike uvicorn, do not raise the captured signal again: this is a normal end."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {number: signal.signal(number, self.handle_exit) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._site.close()
        await super().shutdown(sockets)


def is_loopback(host: str) -> bool:
    """Return True for `localhost` and loopback addresses, which only this machine can reach."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _listen(host: str, port: int) -> socket.socket:
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        return socket.create_server((host, port), family=family, backlog=256)
    except (OSError, OverflowError) as error:
        why = (getattr(error, "strerror", "") or str(error)).lower()
        raise UsageError(
            f"port {port} of {host} is not available: {why}; choose another port with --port, "
            "or find the program that uses it with `ss -ltnp`"
        ) from None
