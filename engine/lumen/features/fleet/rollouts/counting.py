"""Measures of several robots together."""

from collections.abc import Iterable, Mapping

from lumen.features.fleet.rollouts.presence import HOURS
from lumen.features.fleet.settings import FleetMeasure


def rates(counts: Iterable[Mapping[str, float]], measures: Mapping[str, FleetMeasure]) -> dict[str, float]:
    """Return each measure per hour of a robot, or per count of another measure; unknown ones are absent."""
    rows = list(counts)
    found = {}
    for name, measure in measures.items():
        known = [row for row in rows if row.get(HOURS, 0.0) > 0.0 and name in row]
        per = sum(row.get(measure.per or HOURS, 0.0) for row in known)
        if per > 0.0:
            found[name] = sum(row[name] for row in known) / per
    return found
