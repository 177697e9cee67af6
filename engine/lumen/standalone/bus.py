"""Messages by topic, for authors of modules: `connect`, `subscribe`, `publish`, `close`."""

import sys
from pathlib import Path

from lumen.bus.addresses import open_bus
from lumen.bus.validated import OnRefused, validated
from lumen.errors import BusError, Refused
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.upkeep.arguments import need, need_text

__all__ = ["Bus", "BusError", "Message", "Refused", "connect"]


def connect(url: str, project: Project | None = None, *, on_refused: OnRefused | None = None, sender: str = "") -> Bus:
    """Return the bus at `url`.

    `memory://` is a new bus inside this process, `memory://NAME` one that this process shares under that name,
    `amqp://USER:PASSWORD@HOST:PORT/VHOST` (or `amqps://`) a broker; features may add others. With a project, every body
    is validated against the schema of its route: publishing an invalid one raises BusError; for an invalid one
    received, `on_refused` (key, reason) is called instead of the subscriber. `sender` is the program named in its
    messages, by default the name of the running file. Raises BusError, with advice, if the bus can't be opened.
    """
    need_text(url, "the address of a bus")
    if project is not None:
        need(project, Project, "the project of a bus", "a Project, as `lumen.load` gives it")
    bus = open_bus(url, sender or Path(sys.argv[0] or "python").stem)
    return bus if project is None else validated(bus, project, on_refused)
