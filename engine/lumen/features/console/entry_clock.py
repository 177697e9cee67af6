"""The times of entries in a page of a journal, which can begin anywhere in the journal."""

import time
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from lumen.language.events import CLOCK_SET
from lumen.language.iso_time import iso_time
from lumen.language.numbers import is_number


class ToldPage(NamedTuple):
    """Consecutive entries of a journal, each with its `position`.

    `epoch` is the exhibition's time 0 at the first entry [s since 1970], None if unknown.
    """

    entries: Sequence[Mapping[str, Any]]
    epoch: float | None = None


class EntryClock:
    """Computes the time of each entry of a page; call `of` with the entries in their order.

    If the page has no `epoch`, the first epoch in its entries is used. If they have none, the last entry counts as
    happening now.
    """

    def __init__(self, page: ToldPage) -> None:
        told = (epoch for entry in page.entries if (epoch := _epoch_in(entry)) is not None)
        self._epoch = page.epoch if page.epoch is not None else next(told, None)
        if self._epoch is None and page.entries:
            self._epoch = time.time() - _number(page.entries[-1].get("at"))

    def of(self, entry: Mapping[str, Any]) -> str:
        """Return the time of the next entry in ISO 8601 (UTC); 1970-01-01 if it is out of range."""
        told = _epoch_in(entry)
        self._epoch = told if told is not None else self._epoch or 0.0
        try:
            return iso_time(self._epoch + _number(entry.get("at")))
        except (ValueError, OverflowError, OSError):
            return iso_time(0.0)


def _epoch_in(entry: Mapping[str, Any]) -> float | None:
    said = entry.get("snapshot") if "jump" in entry else entry.get("data") if CLOCK_SET in entry.values() else None
    epoch = said.get("epoch") if isinstance(said, Mapping) else None
    return _number(epoch) if epoch is not None else None


def _number(value: object) -> float:
    return float(value) if is_number(value) else 0.0
