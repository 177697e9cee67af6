"""The console's connection to a bus, opened and restored in its own thread."""

import logging
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress

from lumen.errors import BusError, BusRefusedError
from lumen.ports import Bus, EndsWithExhibition, MessageHandler, ReturningBus, UsesBroker
from lumen.run.asking import OPERATOR_ANSWERS
from lumen.run.reaching import Reached
from lumen.upkeep.threads import WatchedThread

LOOK_PERIOD = 0.2
"""The time between two checks of the connection [s]."""
AWAY = "the broker is not connected: no command reaches a robot until it is back"
RETRY_PERIOD = 0.5
"""The pause after a failed attempt to reach the bus [s]."""

_log = logging.getLogger(__name__)


class BusLink:
    """Keeps a bus open from `start` to `close`; `reached` is None while it is not open.

    `patterns` returns the keys to subscribe to on each bus. `heard` receives their messages, and `answered` those on
    the key for answers. `returned` receives the key of each message that no process receives. The bus calls these
    three on its threads. `changed` is called when the bus becomes available or is lost.
    """

    def __init__(
        self,
        reach: Callable[[], Reached],
        patterns: Callable[[Reached], Sequence[str]],
        *,
        heard: MessageHandler,
        answered: MessageHandler,
        returned: Callable[[str], None],
        changed: Callable[[], None],
    ) -> None:
        self.reached: Reached | None = None
        self._trouble = "the console has not reached the bus yet"
        self._reach, self._patterns = reach, patterns
        self._heard, self._answered, self._returned, self._changed = heard, answered, returned, changed
        self._ending = threading.Event()
        self._thread = WatchedThread("lumen-console-bus", self._run)

    @property
    def up(self) -> bool:
        """True while the bus accepts messages."""
        broker = self.reached.bus.ability(UsesBroker) if self.reached else None
        return self.reached is not None and not (broker and broker.away)

    @property
    def trouble(self) -> str:
        """Why the bus accepts no messages; empty while it accepts them."""
        return AWAY if self.reached is not None and not self.up else self._trouble

    @property
    def bus(self) -> Bus | None:
        return self.reached.bus if self.reached else None

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        if self._thread.started:
            self._thread.join(5.0)

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                reached = self._reach()
            except BusError as error:
                self._say(str(error))
                self._ending.wait(RETRY_PERIOD)
                continue
            try:
                self._subscribe(reached)
                self.reached, self._trouble = reached, ""
                self._changed()
                self._watch(reached.bus)
            except BusError as error:
                self._say(str(error))
                self._ending.wait(RETRY_PERIOD)
            finally:
                self.reached = None
                self._changed()
                reached.bus.close()

    def _subscribe(self, reached: Reached) -> None:
        bus = reached.bus
        bus.subscribe(OPERATOR_ANSWERS, self._answered)
        for pattern in self._patterns(reached):
            with suppress(BusRefusedError):  # data that the broker does not let us read is not shown
                bus.subscribe(pattern, self._heard)
        if returning := bus.ability(ReturningBus):
            returning.returns(self._returned)

    def _watch(self, bus: Bus) -> None:
        """Wait until the bus ends or the link closes, and report each loss and return of the broker."""
        ends, was = bus.ability(EndsWithExhibition), self.up
        while not self._ending.wait(LOOK_PERIOD) and not (ends and ends.gone.is_set()):
            if self.up is not was:
                was = self.up
                self._changed()
        if not self._ending.is_set():
            self._say("the exhibition has ended")

    def _say(self, trouble: str) -> None:
        if trouble != self._trouble:
            self._trouble = trouble
            _log.info("%s", trouble)
