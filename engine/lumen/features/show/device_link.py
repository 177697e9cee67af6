"""What every way to a device has: it begins, sends bodies of routes, is looked after, and ends."""

from collections.abc import Callable, Collection
from typing import Any, Protocol

TakeFromDevice = Callable[[str, str, Callable[[], Any]], None]
"""Takes what a device sent: the route, the place that it came on, and what makes a body of it or raises ModuleError."""


class DeviceLink(Protocol):
    """A way to a device. `send` raises ModuleError for what can't be sent; none of these waits for the network."""

    @property
    def routes(self) -> Collection[str]:
        """Those that it carries."""
        ...

    def begin(self) -> None: ...

    def send(self, route: str, body: Any) -> None: ...

    def tick(self) -> None:
        """Called several times a second."""
        ...

    def close(self) -> None: ...
