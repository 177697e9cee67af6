"""How much of it somebody is told: the same once in a while, and nothing in quiet hours."""

from collections.abc import Iterator

from lumen.features.alerts.alert import Alert

LONGEST_WAIT = 30.0
"""How often it is looked whether quiet hours are over [s]."""


class Ration:
    """Takes alerts and gives out those that are due; what is the same is one, with a count, while it is held back."""

    def __init__(self, interval: float) -> None:
        self._interval = interval
        self._held: dict[tuple[str, str], Alert] = {}
        self._given: dict[tuple[str, str], float] = {}

    def take(self, alert: Alert) -> None:
        key = (alert.kind, alert.about)
        earlier = self._held.pop(key, None)
        self._held[key] = alert.after(earlier) if earlier else alert

    def due(self, now: float, *, quiet: bool) -> Iterator[Alert]:
        """What may be told at `now` [s, monotonic], first what was taken first; it counts as told."""
        if quiet:
            return
        self._given = {key: at for key, at in self._given.items() if now - at < self._interval}
        for key in [key for key in self._held if key not in self._given]:
            self._given[key] = now
            yield self._held.pop(key)

    def rest(self) -> Iterator[Alert]:
        """All that is held back."""
        while self._held:
            yield self._held.pop(next(iter(self._held)))

    def wait(self, now: float) -> float | None:
        """In how many seconds something may be due, None where nothing is held back."""
        if not self._held:
            return None
        soonest = min(self._given.get(key, now) + self._interval * (key in self._given) for key in self._held)
        return min(max(soonest - now, 0.01), LONGEST_WAIT)
