"""The interface of links to devices."""

from collections.abc import Callable, Collection
from typing import Any, Protocol

TakeFromDevice = Callable[[str, str, Callable[[], Any]], None]
"""A function that receives a device's message.

Its arguments are the route, the source for reports, such as a topic, and a function that returns the body or raises
ModuleError.
"""


class DeviceLink(Protocol):
    """A link to a device. `send` raises ModuleError if a body can't be sent; no method waits for the network."""

    @property
    def routes(self) -> Collection[str]:
        """The routes that the link carries."""
        ...

    def begin(self) -> None: ...

    def send(self, route: str, body: Any) -> None: ...

    def tick(self) -> None:
        """Do regular work, such as reconnecting; called several times a second."""
        ...

    def close(self) -> None: ...
