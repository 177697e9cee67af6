"""The parts for saved files and for the behaviour's snapshot."""

from collections.abc import Sequence

from lumen.language.events import Event
from lumen.run.live_behavior import LiveBehavior
from lumen.run.parts.part import Part
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader


class ReloadPart(Part):
    """The part that reloads saved files; it comes before the brain, so that bundles change between two steps."""

    patient = True

    def __init__(self, reloader: Reloader, needs: Sequence[str] = ()) -> None:
        self.needs, self._reloader = needs, reloader

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._reloader.tick(now)

    def close(self) -> None:
        self._reloader.close()


class RecordsPart(Part):
    """The part that saves the behaviour's snapshot if the run `lasts`, and completes the journal at the end.

    It comes after the brain, and has the brain's `needs`.
    """

    patient = True

    def __init__(self, records: RunRecords, behavior: LiveBehavior, needs: Sequence[str] = (), *, lasts: bool) -> None:
        self.needs, self._records, self._behavior, self._lasts = needs, records, behavior, lasts

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        if self._lasts:
            self._records.keep(self._behavior.loop)

    def close(self) -> None:
        self._records.close_inputs()
