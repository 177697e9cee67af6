"""Notification of a reload's result to people, modules and the journal."""

import logging
from collections.abc import Iterable
from datetime import UTC, datetime

from lumen.errors import BusError
from lumen.run.live_behavior import LiveBehavior
from lumen.run.narrator import Narrator
from lumen.run.reload.records import RunRecords
from lumen.run.reload.report import ReloadReport
from lumen.run.reload.requests import ReloadRequest, status_key

_log = logging.getLogger(__name__)


class ReloadNotifier:
    """A reporter of results to the terminal, the bus (`lumen.config.status`), the requesters, and the journal."""

    def __init__(self, behavior: LiveBehavior, narrator: Narrator, records: RunRecords) -> None:
        self._behavior, self._narrator, self._records = behavior, narrator, records
        self.last: ReloadReport | None = None
        """The last result; None before the first."""
        self.last_at = datetime.now(UTC)
        """When the last result was reported (UTC)."""

    def tell(self, report: ReloadReport, orders: Iterable[ReloadRequest] = ()) -> None:
        """Report a result, and answer the requests that led to it."""
        lines, body = list(report.lines()), report.to_json()
        self.last, self.last_at = report.kept(), datetime.now(UTC)
        for line in lines:
            self.line(line)
        self._records.write({"at": round(self._behavior.loop.clock.now(), 3), **body})
        told = {**body, "lines": lines}
        for order in orders:
            order.answer(told)
        try:
            loop = self._behavior.loop
            loop.bus.publish(status_key(loop.project.robot), told)
        except BusError as error:
            _log.warning("the result of the reload was not published: %s", error)

    def line(self, text: str) -> None:
        """Print a line on the terminal only."""
        self._narrator.line("reload", text)
