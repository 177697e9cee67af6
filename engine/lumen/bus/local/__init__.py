"""An embedded bus, reached from other processes on the same machine.

Whoever runs an exhibition lets a `LocalBusServer` listen; a `LocalBusClient` connects. They speak JSON in frames over
a socket that only the same user can open (a file of mode 0600, or loopback where there are no such sockets), after each
has proved that it knows the key of the address. Nothing that comes in is ever executed.
"""

from lumen.bus.local.address import LocalAddress
from lumen.bus.local.client import LocalBusClient
from lumen.bus.local.server import LocalBusServer

__all__ = ["LocalAddress", "LocalBusClient", "LocalBusServer"]
