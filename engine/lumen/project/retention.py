"""Read `journal:` and `record:` of lumen.yaml: how long journals and recordings are kept."""

from collections.abc import Mapping
from typing import Any

from lumen.language.retention import LONGEST_RING, SHORTEST_RING, JournalRetention, RecordingSettings
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import finite
from lumen.project.routes import duration
from lumen.project.units import BAD_DURATION


def read_journal(data: Mapping[str, Any], report: DocumentReport) -> JournalRetention:
    """Return how long the journal is kept; a number that can't be used is reported and left out."""
    journal = data.get("journal", {})
    return JournalRetention(**{key: value for key, value in journal.items() if finite(value, report, ("journal", key))})


def read_record(data: Mapping[str, Any], report: DocumentReport) -> RecordingSettings:
    """Return which part of the past is recorded, and how much is kept; a faulty value is reported and left out."""
    said = data["record"]
    numbers = {key: said[key] for key in ("keep", "size") if key in said and finite(said[key], report, ("record", key))}
    ring = duration(said, "ring", report, ("record",))
    if ring is not None and not SHORTEST_RING <= ring <= LONGEST_RING:
        message = (
            f"`ring` can't be {said['ring']}: it must be from {SHORTEST_RING:g} s to {LONGEST_RING / 3600:g} hours"
        )
        report(
            BAD_DURATION,
            ("record", "ring"),
            message,
            hint="write a common value such as `10min`, or delete `ring` to keep nothing",
        )
        ring = None
    return RecordingSettings(ring=ring or 0.0, camera=said.get("camera", True), **numbers)
