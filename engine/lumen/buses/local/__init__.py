"""An embedded bus, reached from other processes on the same machine.

Who runs an exhibition opens a `Door` to its bus; whoever wants to talk to it connects a `LocalBus`. Both speak JSON in
frames over a socket that only the same user can open (a file of mode 0600, or loopback where there are no such
sockets), after each has proved that it knows the key of the address. Nothing that comes in is ever executed.
"""

from lumen.buses.local.addresses import Address
from lumen.buses.local.client import LocalBus
from lumen.buses.local.door import Door

__all__ = ["Address", "Door", "LocalBus"]
