"""What stands under `console:` of lumen.yaml: where its pages are, and who may do what there."""

from collections.abc import Mapping
from dataclasses import dataclass, field

CONSOLE_HOST, CONSOLE_PORT = "127.0.0.1", 8080


@dataclass(frozen=True, slots=True)
class ConsoleSettings:
    """`lumen run` has a console beside it where this is `wanted`.

    `pins` names for a role (`show`, `operator`, `author`) the variable of the environment that holds its PIN; `hosts`
    are other names under which it is reached. `proxies` are addresses or networks of proxies before it, whose
    headers about a request are believed.
    """

    wanted: bool = False
    port: int = CONSOLE_PORT
    host: str = CONSOLE_HOST
    pins: Mapping[str, str] = field(default_factory=dict)
    hosts: tuple[str, ...] = ()
    proxies: tuple[str, ...] = ()
