"""The wall-clock time of a journal's entries."""

from collections.abc import Mapping
from datetime import datetime, time, timedelta

from lumen.expressions.wall_clock import zone
from lumen.insight.replay.entries import LATEST, JournalJump, RecordedEntry
from lumen.language.events import CLOCK_SET


class JournalClock:
    """A journal's wall clock; `epoch` is the time at its time 0 [s since 1970, in UTC], 0 before it is known."""

    def __init__(self, epoch: float | None = None) -> None:
        self.epoch, self._timezone = epoch or 0.0, ""

    def of(self, entry: RecordedEntry) -> float:
        """Return the time of the next entry [s since 1970, in UTC]; call this for each entry in order."""
        if isinstance(entry, JournalJump):
            self._set(entry.snapshot)
            return self.epoch + entry.at
        event = entry.event
        if event.name == event.sendid == CLOCK_SET:
            self._set(event.data)
        return self.epoch + event.at

    def local(self, moment: float) -> datetime:
        """Return a moment in the exhibition's time zone."""
        return datetime.fromtimestamp(moment, zone(self._timezone))

    def next(self, moment: float, wanted: time) -> float:
        """Return the first time from a moment on at which the local clock shows `wanted` [s since 1970, in UTC]."""
        here = self.local(moment)
        then = datetime.combine(here.date(), wanted, here.tzinfo)
        return (then if then >= here else then + timedelta(days=1)).timestamp()

    def _set(self, said: object) -> None:
        if isinstance(said, Mapping):
            epoch, timezone = said.get("epoch"), said.get("timezone")
            if isinstance(epoch, int | float) and 0 <= epoch < LATEST:
                self.epoch = float(epoch)
            if isinstance(timezone, str):
                self._timezone = timezone
