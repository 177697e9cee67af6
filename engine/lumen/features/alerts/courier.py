"""Delivers alerts to one recipient on a separate thread, with a rate limit, quiet hours and retries."""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from datetime import datetime
from datetime import time as TimeOfDay  # noqa: N812

from lumen.errors import UndeliveredError
from lumen.features.alerts.alert import Alert
from lumen.features.alerts.settings import Recipient
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

LONGEST_WAIT = 30.0
"""The maximum time between two checks for due alerts, for example after quiet hours [s]."""


class Ration:
    """Limits alerts of equal kind and `about` to one per `interval` [s]; held alerts are merged and counted."""

    def __init__(self, interval: float) -> None:
        self._interval = interval
        self._held: dict[tuple[str, str], Alert] = {}
        self._given: dict[tuple[str, str], float] = {}

    def take(self, alert: Alert) -> None:
        """Hold back an alert until it is due, merged with a held alert of equal kind and `about`."""
        key = (alert.kind, alert.about)
        earlier = self._held.pop(key, None)
        self._held[key] = alert.after(earlier) if earlier else alert

    def due(self, now: float, *, quiet: bool) -> Iterator[Alert]:
        """Yield the alerts that are due at `now` [s, monotonic], in order of arrival, and count them as sent.

        If `quiet`, yield no alerts.
        """
        if quiet:
            return
        self._given = {key: at for key, at in self._given.items() if now - at < self._interval}
        for key in [key for key in self._held if key not in self._given]:
            self._given[key] = now
            yield self._held.pop(key)

    def remaining(self) -> Iterator[Alert]:
        """Remove and yield all held alerts."""
        while self._held:
            yield self._held.pop(next(iter(self._held)))

    def wait(self, now: float) -> float | None:
        """Return the time until the next alert is due [s], at most `LONGEST_WAIT`; None if no alert is held."""
        if not self._held:
            return None
        soonest = min(self._given.get(key, now) + self._interval * (key in self._given) for key in self._held)
        return min(max(soonest - now, 0.01), LONGEST_WAIT)


MAX_PENDING_ALERTS = 100
"""The maximum number of alerts that wait for the thread; beyond it, the oldest are dropped."""
FIRST_RETRY, LONGEST_RETRY = 1.0, 300.0
"""The first and the longest wait before another attempt [s]; the wait doubles each time."""
RETRY_FOR = 3_600.0
"""The time for which the delivery of an alert is retried [s]."""

Deliver = Callable[[Alert], None]
"""A function that delivers an alert and waits for the result. Raises UndeliveredError if the alert did not arrive."""


def time_of_day() -> TimeOfDay:
    """Return the local time of day."""
    return datetime.now().time()


class Courier:
    """Accepts alerts without waiting (`put`), and delivers them one at a time.

    `tell` receives one line, with the reason, for each outage. `clock` returns monotonic time [s], `day` the local time
    of day.
    """

    def __init__(
        self,
        recipient: Recipient,
        interval: float,
        deliver: Deliver,
        tell: Callable[[str], None],
        *,
        clock: Callable[[], float] = time.monotonic,
        day: Callable[[], TimeOfDay] = time_of_day,
    ) -> None:
        self.recipient = recipient
        self._deliver, self._tell, self._clock, self._day = deliver, tell, clock, day
        self._ration = Ration(interval)
        self._received: deque[Alert] = deque(maxlen=MAX_PENDING_ALERTS)
        self._changed = threading.Condition()
        self._ending = self._failing = False
        self._until = 0.0
        self._thread = WatchedThread("lumen-alerts", self._run)
        self._thread.start()

    def put(self, alert: Alert) -> None:
        """Queue an alert for delivery if the recipient wants its kind."""
        if alert.kind in self.recipient.kinds:
            with self._changed:
                self._received.append(alert)
                self._changed.notify_all()

    def end(self, until: float) -> None:
        """Make the thread deliver waiting alerts until `until` [s, monotonic], or drop them in quiet hours, and end.

        Return immediately.
        """
        with self._changed:
            self._ending, self._until = True, until
            self._changed.notify_all()

    def join(self) -> None:
        """Wait until the thread has ended, at most until the time passed to `end`."""
        self._thread.join(max(0.0, self._until - self._clock()))

    def _run(self) -> None:
        while not self._ended():
            for alert in self._due():
                self._tell_until_told(alert)

    def _ended(self) -> bool:
        """Wait for an alert, a due time or `end`; return whether the thread must end."""
        with self._changed:
            if not (self._received or self._ending):
                self._changed.wait(self._ration.wait(self._clock()))
            return self._ending and not self._received and self._ration.wait(self._clock()) is None

    def _due(self) -> list[Alert]:
        with self._changed:
            came = list(self._received)
            self._received.clear()
        for alert in came:
            self._ration.take(alert)
        quiet = self.recipient.quiet is not None and self.recipient.quiet.hold(self._day())
        if self._ending:
            rest = list(self._ration.remaining())
            return [] if quiet else rest
        return list(self._ration.due(self._clock(), quiet=quiet))

    def _tell_until_told(self, alert: Alert) -> None:
        began, backoff = self._clock(), Backoff(FIRST_RETRY, LONGEST_RETRY)
        while True:
            try:
                self._deliver(alert)
            except UndeliveredError as error:
                if not self._failing:
                    self._failing = True
                    self._tell(str(error))
                if error.final or self._clock() - began > RETRY_FOR or not self._paused(backoff.next()):
                    return
            else:
                self._failing = False
                return

    def _paused(self, seconds: float) -> bool:
        """Wait before the next attempt; return False if that attempt would be after the end."""
        with self._changed:
            deadline = self._clock() + seconds
            while not self._ending and self._clock() < deadline:
                self._changed.wait(deadline - self._clock())
            if not self._ending:
                return True
            self._changed.wait_for(lambda: False, max(0.0, min(deadline, self._until) - self._clock()))
            return self._clock() < self._until
