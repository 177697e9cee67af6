"""A bus inside one process that counts its letters."""

from lumen.bus.memory import MemoryBus
from lumen.ports import Outgoing


class Postbox(MemoryBus):
    """The postbox of an address."""

    posted = 0

    def __init__(self, url: str, sender: str) -> None:
        super().__init__(url, sender)

    def send(self, message: Outgoing) -> None:
        Postbox.posted += 1
        super().send(message)
