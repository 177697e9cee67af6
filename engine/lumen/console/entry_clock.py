"""When entries of a journal were made, as pages of it tell: in order, and not from its beginning."""

import time
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from lumen.language.events import CLOCK_SET


class EntryClock:
    """Follows entries; until one of them says so, it is not known when the exhibition's time 0 was.

    Then the next one that says so counts, and where there is none, the newest entry was made just now.
    """

    def __init__(self) -> None:
        self._epoch: float | None = None

    def look_ahead(self, entries: Sequence[Mapping[str, Any]]) -> None:
        """These are the next."""
        if self._epoch is None and entries:
            told = (epoch for entry in entries if (epoch := _epoch_in(entry)) is not None)
            self._epoch = next(told, None)
            if self._epoch is None:
                self._epoch = time.time() - _number(entries[-1].get("at"))

    def of(self, entry: Mapping[str, Any]) -> str:
        """When the next one was made, ISO 8601 in UTC."""
        told = _epoch_in(entry)
        self._epoch = told if told is not None else self._epoch or 0.0
        try:
            moment = datetime.fromtimestamp(self._epoch + _number(entry.get("at")), UTC)
        except (ValueError, OverflowError, OSError):
            moment = datetime.fromtimestamp(0.0, UTC)
        return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _epoch_in(entry: Mapping[str, Any]) -> float | None:
    said = entry.get("snapshot") if "jump" in entry else entry.get("data") if CLOCK_SET in entry.values() else None
    epoch = said.get("epoch") if isinstance(said, Mapping) else None
    return _number(epoch) if epoch is not None else None


def _number(value: object) -> float:
    return float(value) if type(value) in (int, float) else 0.0  # type: ignore[arg-type]
