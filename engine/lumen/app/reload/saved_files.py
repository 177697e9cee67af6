"""Saved files, taken while the behaviour runs; and where it stands, kept for a run after this one."""

from collections.abc import Sequence

from lumen.app.live_behavior import LiveBehavior
from lumen.app.parts.part import Part
from lumen.app.reload.records import RunRecords
from lumen.app.reload.reloader import Reloader
from lumen.language.events import Event


class ReloadPart(Part):
    """Takes saved files; it stands before the brain, whose `needs` it has, so that a bundle comes between two steps."""

    patient = True

    def __init__(self, reloader: Reloader, needs: Sequence[str] = ()) -> None:
        self.needs, self._reloader = needs, reloader

    def begin(self, now: float) -> None:
        self._reloader.wake = self.wake

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._reloader.tick(now)

    def close(self) -> None:
        self._reloader.close()


class RecordsPart(Part):
    """Keeps where the behaviour stands; it stands after the brain, whose `needs` it has."""

    patient = True

    def __init__(self, records: RunRecords, behavior: LiveBehavior, needs: Sequence[str] = ()) -> None:
        self.needs, self._records, self._behavior = needs, records, behavior

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._records.keep(self._behavior.loop)
