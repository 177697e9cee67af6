"""The second names of keys: those of 2015, which assumed one robot, and when they are used.

A message is sent under its key and under the alias; the id of the copy is marked, so that a subscriber to both gets it
once. While another robot is on the bus aliases are not used, so that no robot receives another's visitor.
"""

import logging
import time
from collections.abc import Callable, Mapping
from math import inf

from lumen.errors import BusError
from lumen.language.projects import Project
from lumen.language.routing_keys import DEFAULT_ALIASES, DEFAULT_KEYS, INTERNAL_ALIASES, default_key, key_of_robot
from lumen.ports import Bus, Message, MessageHandler
from lumen.upkeep.drops import TELL_PERIOD

COPY = "/alias"
"""The end of the id of a copy that is sent under an alias."""
AWAY_AFTER = 10.0
"""Silence after which another robot counts as gone [s]; its signs of life come every half second."""
MAX_ROBOTS = 100
"""The number of other robots that are remembered; one more replaces the one that has been silent for longest."""
MAX_NAME = 100
"""The number of characters that are kept of each name."""
PRESENCE = "presence"

_log = logging.getLogger(__name__)


def aliases_of(project: Project) -> Mapping[str, str]:
    """Return the aliases of a project's keys, and of Lumen's keys that it does not list; empty if it uses none."""
    if project.aliases is False or (project.aliases is None and len(project.served) > 1):
        return {}
    listed = {row.key_for(project.robot): row.alias for row in project.routes.values() if row.alias}
    unlisted = DEFAULT_ALIASES.keys() - project.routes.keys()
    own = {default_key(route, project.robot): DEFAULT_ALIASES[route] for route in unlisted}
    return {key_of_robot(key, project.robot): alias for key, alias in INTERNAL_ALIASES.items()} | own | listed


class Aliases:
    """The aliases that are in use now, depending on the presence of other robots. Safe from any thread."""

    def __init__(self) -> None:
        self.names: Mapping[str, str] = {}
        """The alias of each key."""
        self._project: Project | None = None
        self._others: dict[str, float] = {}
        self._warned = -inf
        self._undo: list[Callable[[], None]] = []

    def use(self, project: Project, bus: Bus) -> None:
        """Switch to this project's aliases; if there are any, subscribe to the presence of other robots."""
        old, self._undo, self._project = self._undo, [], project
        self.names = aliases_of(project)
        for pattern in _presences(project) if self.names else ():
            try:
                self._undo.append(bus.subscribe(pattern, self._hear))
            except BusError as error:
                _log.debug("other robots on the bus cannot be detected: %s", error)
        for undo in old:
            undo()

    @property
    def used(self) -> bool:
        """Whether aliases are used now: while no other robot is there, or if the project requires them."""
        if not self._others or (self._project and self._project.aliases):
            return True
        return time.monotonic() - max(self._others.values()) > AWAY_AFTER

    def taking(self, handler: MessageHandler) -> MessageHandler:
        """Return a handler for an alias.

        It ignores copies, which also arrive under the key, and all messages while aliases are not used.
        """

        def take(message: Message) -> None:
            if self.used and not message.id.endswith(COPY):
                handler(message)

        return take

    def _hear(self, message: Message) -> None:
        match message.body:
            case {"robot": str(robot), "state": str()} if self._project and robot != self._project.robot:
                robot = robot[:MAX_NAME]
                known, now = robot in self._others, time.monotonic()
                if not known and len(self._others) >= MAX_ROBOTS:
                    del self._others[min(self._others, key=self._others.__getitem__)]
                self._others[robot] = now
                if not known and now - self._warned >= TELL_PERIOD:
                    self._warned = now
                    self._warn(robot, self._project)

    def _warn(self, robot: str, project: Project) -> None:
        shared = [f"`{n}`" for n, row in project.routes.items() if row.event and "{robot}" not in row.key]
        both = (
            f"; both robots receive the messages on {', '.join(shared)}: write `{{robot}}` into the key"
            if shared
            else ""
        )
        if project.aliases:
            what = f"lumen.yaml of {project.robot} has `aliases: true`: no other robot may have it"
        else:
            what = (
                "while it is there, Lumen neither accepts nor sends messages under an `alias` (see "
                "`aliases` in lumen.yaml)"
            )
        _log.warning("another robot, %.100s, is on this bus: %s%s", robot, what, both)


def _presences(project: Project) -> tuple[str, ...]:
    """Return the keys of robots' presence: one pattern for keys with a name, and the common key."""
    row = project.routes.get(PRESENCE)
    key, alias = (row.key, row.alias) if row else (DEFAULT_KEYS[PRESENCE], DEFAULT_ALIASES[PRESENCE])
    return tuple(dict.fromkeys(found for found in (key.replace("{robot}", "*"), alias) if found))
