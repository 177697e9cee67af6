"""An embedded bus, reached from other processes on the same machine.

The process of an exhibition runs a `LocalBusServer`; a `LocalBusClient` connects. They exchange JSON in frames over a
socket that only the same user can open (a file of mode 0600, or loopback on systems without such sockets), after each
has proved that it has the address's key. Received data is never executed.
"""

from lumen.bus.local.address import LocalAddress
from lumen.bus.local.client import LocalBusClient
from lumen.bus.local.server import LocalBusServer

__all__ = ["LocalAddress", "LocalBusClient", "LocalBusServer"]
