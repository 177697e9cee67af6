"""The choice of a recorded visit by a time of day."""

from collections.abc import Sequence
from datetime import datetime, time, timedelta
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.insight.replay.journal_clock import JournalClock
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.run.replaying.journals import ChosenJournal, KeptBundles, requested_time
from lumen.run.replaying.other_files import with_machines


class ChosenVisit(NamedTuple):
    """A visit, and its local time at the exhibition."""

    visit: RecordedVisit
    began: datetime
    ended: datetime

    @property
    def when(self) -> str:
        """The time of the visit, in words."""
        return f"from {self.began:%H:%M:%S} to {self.ended:%H:%M:%S} on {self.began:%Y-%m-%d}"


def chosen_visit(journal: ChosenJournal, bundles: KeptBundles, at: str | None) -> ChosenVisit:
    """Return the visit that was under way at a time of day; the last visit if `at` is None.

    `14:03` means any time in that minute. Raises UsageError, naming the nearest visit, if no visit was under way then;
    also if a visitor in it was forgotten.
    """
    entries, clock = list(journal.entries()), JournalClock()
    for entry in entries:
        clock.of(entry)
    found = [
        ChosenVisit(visit, clock.local(visit.began), clock.local(visit.ended))
        for visit in visits(with_machines(entries, bundles))
    ]
    if not found:
        raise UsageError("that journal has no visit; `lumen replay --list` lists the files")
    one = _under_way(found, at) if at else found[-1]
    if one.visit.redacted:
        raise UsageError(f"the visit {one.when} is redacted: a visitor in it was forgotten, and the words are gone")
    return one


def _under_way(found: Sequence[ChosenVisit], at: str) -> ChosenVisit:
    wanted, length = requested_time(at), timedelta(minutes=1) if at.count(":") == 1 else timedelta(seconds=1)
    nearest = min(found, key=lambda one: _distance(one, wanted, length))
    if _distance(nearest, wanted, length):
        raise UsageError(f"no visit was under way at {at}; the nearest was {nearest.when}")
    return nearest


def _distance(one: ChosenVisit, wanted: time, length: timedelta) -> timedelta:
    """Return the gap between a visit and the `length` of time from `wanted` on; zero if they overlap."""
    days = {one.began.date(), one.ended.date()}
    moments = [datetime.combine(day, wanted, one.began.tzinfo) for day in days]
    return min(max(one.began - (moment + length), moment - one.ended, timedelta()) for moment in moments)
