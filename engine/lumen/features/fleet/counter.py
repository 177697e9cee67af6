"""Counts what fleet.yaml measures, from the steps of a behaviour."""

from collections.abc import Mapping
from fnmatch import fnmatchcase

from lumen.features.fleet.settings import FleetMeasure
from lumen.run.loop import Observer
from lumen.statechart import Step


class MeasureCounter(Observer):
    """`take` gives what was counted since it was called last."""

    def __init__(self, measures: Mapping[str, FleetMeasure]) -> None:
        self._measures, self._counts = measures, dict.fromkeys(measures, 0)

    def stepped(self, step: Step) -> None:
        events = [event.name for event in (step.event, *step.raised) if event]
        for name, measure in self._measures.items():
            if measure.event:
                self._counts[name] += sum(fnmatchcase(event, measure.event) for event in events)
            if measure.enters:
                self._counts[name] += sum(fnmatchcase(state, measure.enters) for state in step.entered)

    def take(self) -> dict[str, int]:
        """How often each was counted since the last call."""
        found, self._counts = self._counts, dict.fromkeys(self._measures, 0)
        return found
