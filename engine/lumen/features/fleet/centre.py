"""A centre, which collects the robots' reports, advances a rollout, and sends each house its orders."""

import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any

from lumen.bus.brokers import Stream, StreamEntry
from lumen.errors import BusError, UsageError
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.centre_journal import CentreJournal
from lumen.features.fleet.fleet_log import FleetLog
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.overview import overview
from lumen.features.fleet.rollouts.orders import DesiredState
from lumen.features.fleet.rollouts.presence import presence_from
from lumen.features.fleet.rollouts.rollout import step
from lumen.features.fleet.rollouts.state import CentreState, HeardPresence
from lumen.features.fleet.settings import Fleet
from lumen.features.fleet.signing import ORDER, Signer
from lumen.language.counts import counted
from lumen.language.fleet_keys import KEPT, PRESENCE, bundle_key, desired_key, robot_of
from lumen.ports import Bus, Message

TELL_PERIOD = 10.0
"""The time after which an unchanged order is sent to a house again [s]; changes are sent immediately."""
BUNDLE_PERIOD = 20.0
"""The minimum time before a bundle is sent to a house again [s]."""
KEEP_PERIOD = 60.0
"""The time between two journal lines that record only how long a step has been watched [s]."""
MAX_WAITING = 20_000


class Centre:
    """The centre of one fleet, on the centre's bus. Call `tick` about once a second.

    Every decision is in the journal before it is sent; if the journal can't be written, the centre decides nothing, and
    `trouble` has the reason. `clock` returns the time [s since 1970]. Incidents and counts are read from the `stream`;
    without a stream, they arrive on the bus and are lost while no centre is running. `tell` receives lines for the
    operator.
    """

    def __init__(
        self,
        fleet: Fleet,
        state: CentreState,
        journal: CentreJournal,
        bundles: BundleFolder,
        signer: Signer,
        bus: Bus,
        log: FleetLog,
        stream: Stream | None = None,
        *,
        tell: Callable[[str], None] = lambda _: None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self.fleet, self.state, self.bundles, self.trouble = fleet, state, bundles, ""
        self.heard: dict[str, HeardPresence] = {}
        self.log, self._stream = log, stream
        self._journal, self._signer, self._bus, self._tell, self._clock = journal, signer, bus, tell, clock
        self._received: deque[Message] = deque(maxlen=MAX_WAITING)
        self._told, self._version, self._kept = 0.0, -1, 0.0
        self._sent: dict[tuple[str, str], float] = {}
        self._known = frozenset(fleet.robots)
        heard = (PRESENCE,) if stream else (PRESENCE, *KEPT)
        self._undo = [bus.subscribe(f"{key}.*.*", self._received.append) for key in heard]

    def tick(self) -> None:
        """Process received messages, advance the rollout, and send orders."""
        now = self._clock()
        while self._received:
            self._hear(self._received.popleft(), now)
        for entry in self._stream.take() if self._stream else ():
            self._count(entry, now)
        if why := self.log.save():
            self._tell(f"the centre's log can't be written: {why}")
        self._decide(step(self.state, self.fleet, self.heard, now), now)
        if not self.trouble and not self.state.overruled:
            self._order(now)

    def change(self, state: CentreState, what: str) -> None:
        """Set a state that an operator chose; `what` describes the change in the journal and in the output.

        Raises UsageError if the journal can't be written.
        """
        if why := self._journal.write(what, state):
            raise UsageError(f"the centre's journal can't be written: {why}")
        self.state, self.trouble = state, ""
        self._tell(what)

    def overview(self) -> dict[str, Any]:
        """Return the fleet's state as JSON data."""
        told = overview(self.fleet, self.state, self.heard, self._clock())
        return told | {
            "incidents": list(self.log.incidents)[-20:],
            "kinds": self.log.kinds,
            "numbers": self.log.numbers(self.fleet.measures),
            "trouble": self.trouble,
            "bundles": self.bundles.hashes(),
        }

    def close(self) -> None:
        """End the subscriptions and save the log."""
        for undo in self._undo:
            undo()
        self.log.save(now=True)

    def _hear(self, message: Message, now: float) -> None:
        robot = robot_of(message.key)
        if robot not in self._known:
            return
        if not message.key.startswith(f"{PRESENCE}."):
            self._count(StreamEntry(-1, message.key, message.body, message.id, message.time), now)
            return
        said = presence_from(robot, message.body)
        if said is not None:
            self.heard[robot] = HeardPresence(said, now)
            if said.wants:
                self._send(said.robot.partition("/")[0], said.wants, now)

    def _count(self, entry: StreamEntry, now: float) -> None:
        """Count a message in the log; messages of robots outside the fleet only advance the stream's offset."""
        known = robot_of(entry.key) in self._known
        if line := self.log.take(entry if known else entry._replace(body=None), now):
            self._tell(line)

    def _send(self, house: str, hash: str, now: float) -> None:
        """Send a house the bundle that a robot there lacks, unless it was sent recently or is unknown here."""
        if abs(now - self._sent.get((house, hash), -BUNDLE_PERIOD)) < BUNDLE_PERIOD:
            return
        files = self.bundles.files(hash)
        if files is not None:
            self._sent[house, hash] = now
            for body in messages_of(files, self._signer):
                self._publish(bundle_key(house), body, 60.0)

    def _decide(self, state: CentreState, now: float) -> None:
        before, after = _settled(self.state), _settled(state)
        if after != before or (state.rollout != self.state.rollout and abs(now - self._kept) > KEEP_PERIOD):
            what = _said(state)
            self.trouble = self._journal.write(what, state)
            if self.trouble:
                return
            self._kept = now
            if after != before:
                self._tell(what)
        self.state = state

    def _order(self, now: float) -> None:
        if self._version == self.state.version and abs(now - self._told) < TELL_PERIOD:
            return
        self._version, self._told = self.state.version, now
        for name, house in self.fleet.houses.items():
            rows = ((robot, self.state.wanted.get(f"{name}/{robot}", "")) for robot in house.robots)
            wanted = {robot: want for robot, want in rows if want}
            state = self.state
            text = DesiredState(state.centre, state.term, state.version, name, wanted, state.trying).text()
            self._publish(
                desired_key(name), {"order": text, "signature": self._signer.sign(ORDER, text.encode())}, 60.0
            )

    def _publish(self, key: str, body: Any, ttl: float) -> None:
        with suppress(BusError):  # orders and bundles are sent again
            self._bus.publish(key, body, ttl=ttl)


def _settled(state: CentreState) -> CentreState:
    """Return the state without the times that change at each tick."""
    rollout = state.rollout and replace(state.rollout, watched=0.0, waited=0.0)
    return replace(state, looked=0.0, rollout=rollout)


def _said(state: CentreState) -> str:
    rollout = state.rollout
    if state.overruled:
        return state.overruled
    if rollout is None:
        return "the centre continues"
    at = f"step {rollout.at + 1} of {len(rollout.plan.steps)} ({rollout.plan.steps[rollout.at]})"
    reason = f": {rollout.reason}" if rollout.reason else ""
    return f"bundle {rollout.bundle[:12]}: {rollout.state}, {at}, {counted(len(rollout.assigned), 'robot')}{reason}"
