"""Messages by topic: the buses behind `lumen.ports.Bus`, from `lumen.bus.connect`; for modules, `lumen.bus.join`.

    memory.py         the embedded bus, in this process
    local/            the embedded bus of another process of this machine: a server, its clients
    addresses.py      the kinds of buses, by the schemes of their addresses
    brokers.py        what a broker offers besides a bus: answers about itself, and streams
    validated.py      any bus, with every body checked against the schema of its route
    checked_bus.py    the bus of an installed package, whose faults name the package

Data on a bus:

    bodies.py         JSON data as bytes and back, and what bodies and keys may be
    identities.py     ids of messages, and checks of the ids, senders and times that arrive
    aliases.py        second names of keys, while one robot is on the bus
    checking.py       what is wrong with a body, by its JSON Schema, in a line

Each name is imported when it is first used. `__init__.pyi` has the same names for type checkers.
"""

from lumen.upkeep.lazy_names import lazy

__all__ = ["Bus", "BusError", "JoinedModule", "Message", "Refused", "connect", "join"]

_HOMES = {
    "lumen.standalone.bus": ("connect",),
    "lumen.run.joining": (
        "JoinedModule",
        "join",
    ),
    "lumen.errors": (
        "BusError",
        "Refused",
    ),
    "lumen.ports": (
        "Bus",
        "Message",
    ),
}

__getattr__ = lazy(__name__, _HOMES)
