"""The processes of an exhibition: each publishes signs of life, and notices when another falls silent."""

import logging
import os
import platform
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.errors import BusError
from lumen.feature import rows
from lumen.language.events import Event
from lumen.language.modules import module_names
from lumen.language.routing_keys import DEFAULT_ALIASES
from lumen.ports import Bus, Message

PRESENCE_ROUTE = "presence"
PRESENCE_KEY = DEFAULT_ALIASES[PRESENCE_ROUTE]
"""The default key of signs of life: that of a bus with one robot."""
ROBOT_PART, BRAIN, MOTION, VISITOR = "robot", "brain", "motion", "visitor"
"""The roles that Lumen's own code refers to; `roles` has all of them."""
PRESENCE_PERIOD = 0.5
"""The time between two signs of life [s]."""
LOST_AFTER = 4.0
"""The silence after which a process is lost [s]; a process that hangs for 3 s is not."""
PRESENCE_TTL = 2.0
"""The time to live of a sign of life on the bus [s]."""
MAX_PEERS = 100
"""The number of known processes at which those silent for LOST_AFTER are forgotten, to bound the memory."""

ASKS, HERE, LEAVES = "asks", "here", "leaves"
"""States of a process in its signs of life."""

_log = logging.getLogger(__name__)


def roles() -> tuple[str, ...]:
    """Return the roles that a process can have besides the modules; those of Lumen come first."""
    return tuple(role for _, role in rows("roles"))


def all_parts() -> tuple[str, ...]:
    """Return the parts that a process can have: all roles, then the modules."""
    return (*roles(), *module_names())


def unique_parts() -> tuple[str, ...]:
    """Return the parts of which each robot has one, unlike visitors."""
    return tuple(part for part in all_parts() if part != VISITOR)


def host_of(module: str) -> str:
    """Return the part of a process that starts the program of a module of the project's own.

    The module itself is there only while that program runs.
    """
    return f"host of {module}"


@dataclass
class Peer:
    """Another process, as its signs of life describe it."""

    session: str
    """The id of the process, new at each start."""
    parts: tuple[str, ...]
    """The parts that the process has."""
    since: float
    """When the process was first noticed [s, monotonic]."""
    heard: float
    """When the last sign of life arrived [s, monotonic]."""
    state: str
    """`asks`, `here` or `leaves`."""
    said: Mapping[str, Any]
    """The body of the last sign of life."""


class Presence:
    """This process among those of one robot's exhibition.

    Until `settle` its signs of life ask the others to answer at once. `more` returns further fields of its signs of
    life.
    """

    def __init__(
        self,
        bus: Bus,
        robot: str,
        parts: Iterable[str],
        *,
        key: str = PRESENCE_KEY,
        session: str = "",
        clock: Callable[[], float] = time.monotonic,
        more: Callable[[], Mapping[str, Any]] = dict,
    ) -> None:
        self.robot, self.parts, self.session = robot, tuple(parts), session or uuid.uuid4().hex[:12]
        self.came: list[Peer] = []
        """The processes that appeared in the last tick."""
        self._bus, self._key, self._clock, self._more = bus, key, clock, more
        self._state = ASKS
        self._next = 0.0
        self._ticked = clock()
        self._messages: deque[Message] = deque(maxlen=1_000)
        self._peers: dict[str, Peer] = {}
        self._lost: dict[str, float] = {}
        self._known: set[str] = set()
        self._undo = bus.subscribe(key, self._messages.append)

    @property
    def claims(self) -> tuple[str, ...]:
        """The parts of this process of which each robot has one, unlike visitors."""
        return tuple(part for part in self.parts if part != VISITOR)

    @property
    def settled(self) -> bool:
        """Whether the claim has ended, and this process has not left."""
        return self._state == HERE

    def settle(self) -> None:
        """End the claim: this process now has its parts."""
        self._state, self._next = HERE, 0.0

    def find(self, part: str) -> Peer | None:
        """Return the live process that has a part, after its claim; the oldest of several, None if there is none."""
        peers = (peer for peer in self._peers.values() if part in peer.parts and peer.state == HERE)
        found = filter(self.alive, peers)
        return min(found, key=lambda p: p.since, default=None)

    def get(self, session: str) -> Peer | None:
        """Return the process of a session, however old its last sign of life is; None if it is unknown."""
        return self._peers.get(session)

    def alive(self, peer: Peer) -> bool:
        """Return whether a process has sent a sign of life within LOST_AFTER, and has not left."""
        return self._clock() - peer.heard <= LOST_AFTER and peer.state != LEAVES

    def left(self, part: str) -> bool:
        """Return whether the process that last had a part has announced its end."""
        peers = [peer for peer in self._peers.values() if part in peer.parts]
        return bool(peers) and max(peers, key=lambda peer: peer.heard).state == LEAVES

    def peers(self) -> list[Peer]:
        """Return all other live processes."""
        return [peer for peer in self._peers.values() if self.alive(peer)]

    def rival(self, part: str) -> Peer | None:
        """Return another process that was there before with the same part, or claims it now with a lower session id.

        None without such a process, or once this one is settled.
        """
        if self.settled:
            return None
        for peer in self.peers():
            earlier = peer.state == HERE or peer.session < self.session
            if part in peer.parts and earlier:
                return peer
        return None

    def tick(self) -> list[Event]:
        """Send a sign of life when it is due, and read those of others; return the changes.

        These are `robot.lost`, `robot.back`, and the same for `motion` and the other modules: events without a time of
        their own, with the duration of the absence as `seconds` [s].
        """
        now, self.came = self._clock(), []
        self._excuse(now)
        while self._messages:
            self._hear(self._messages.popleft().body, now)
        if now >= self._next:
            self._next = now + PRESENCE_PERIOD
            self._say(self._state)
        return self._changes(now)

    def _excuse(self, now: float) -> None:
        """Move the others' last signs of life forward by a pause of this process, in which it did not read them."""
        stood, self._ticked = now - self._ticked, now
        if stood > PRESENCE_PERIOD:
            for peer in self._peers.values():
                peer.heard += stood

    def close(self) -> None:
        """Announce that this process leaves; calling it again does no harm."""
        if self._state != LEAVES:
            self._state = LEAVES
            self._undo()
            self._say(LEAVES)

    def _say(self, state: str) -> None:
        body = {
            "robot": self.robot,
            "parts": list(self.parts),
            "session": self.session,
            "state": state,
            "host": platform.node(),
            "process": os.getpid(),
            **self._more(),
        }
        try:
            self._bus.publish(self._key, body, ttl=PRESENCE_TTL)
        except BusError as error:
            _log.debug("the presence of this process was not published: %s", error)

    def _hear(self, body: Any, now: float) -> None:
        match body:
            case {"robot": self.robot, "parts": list(parts), "session": str(session), "state": str(state)}:
                pass
            case _:
                return
        if session == self.session:
            return
        known = self._peers.get(session)
        if known is None:
            if len(self._peers) >= MAX_PEERS:
                self._peers = {s: p for s, p in self._peers.items() if now - p.heard <= LOST_AFTER}
            known = self._peers[session] = Peer(session, tuple(map(str, parts)), now, now, state, body)
            self.came.append(known)
        if state == ASKS:
            self._next = 0.0
        known.parts, known.heard, known.state, known.said = tuple(map(str, parts)), now, state, body

    def _changes(self, now: float) -> list[Event]:
        """Return the events of the robot and the modules that were lost or came back since the last tick."""
        events = []
        for part in (ROBOT_PART, MOTION, *module_names()):
            if part in self.parts:
                continue
            here = self.find(part) is not None
            if here and part in self._lost:
                events.append(Event(f"{part}.back", {"seconds": round(now - self._lost.pop(part), 3)}))
            elif not here and part in self._known and part not in self._lost:
                last = [peer.heard for peer in self._peers.values() if part in peer.parts]
                self._lost[part] = max(last, default=now)
                events.append(Event(f"{part}.lost", {"seconds": round(now - self._lost[part], 3)}))
            if here:
                self._known.add(part)
        return events


def where_it_runs(peer: Peer) -> str:
    """Return a process's location, such as `process 4711 on stand`."""
    return f"process {str(peer.said.get('process', '?'))[:20]} on {str(peer.said.get('host', '?'))[:60]}"
