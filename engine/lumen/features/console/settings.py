"""The settings under `console:` of lumen.yaml: the address of the pages, and the PINs of the roles."""

from collections.abc import Mapping
from dataclasses import dataclass, field

CONSOLE_HOST, CONSOLE_PORT = "127.0.0.1", 8080


@dataclass(frozen=True, slots=True)
class ConsoleSettings:
    """The section `console:` of lumen.yaml."""

    wanted: bool = False
    """True if `lumen run` starts a console in a separate process."""
    port: int = CONSOLE_PORT
    host: str = CONSOLE_HOST
    pins: Mapping[str, str] = field(default_factory=dict)
    """For each role (`show`, `operator`, `author`), the environment variable that holds its PIN."""
    hosts: tuple[str, ...] = ()
    """Other names under which browsers reach the console."""
    proxies: tuple[str, ...] = ()
    """Addresses or networks of proxies whose headers about a request are trusted."""
